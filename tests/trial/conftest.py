"""Voyages, for tests of reading them."""

from tests.voyages.conftest import voyage, voyage_file

__all__ = ["voyage", "voyage_file"]
