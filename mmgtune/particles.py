"""Particles: coefficients of one ship many times over, as probable as her trials leave them, and their file.

A particle is a column of numbers of a profile, coefficients and parameters of effects.  All weigh the same.  What is
predicted by all of them is a prediction that knows how well it is known.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .arrays import FloatArray
from .backends import Integrator
from .components import effect_tag, split_name
from .documents import RepeatedKey, parsed
from .effects import FilterEffect, FlowEffect, SensorEffect
from .errors import OptionError, Problem, ProfileError, must_be_a, reason
from .files import path_of, require_regular
from .model import Model
from .parquet_tables import write_table
from .predictor import PhysicsPredictor, Sampling
from .profile import ShipProfile, parse_profile, with_effects
from .resources import in_run, must_be_name
from .run_files import PARTICLES
from .trial.footer import rows_of
from .trial.parquet import numbers as plain_numbers

KEY = b"mmgtune_particles"
SCHEMA = 1

LARGEST = 1e12
"""Size of a number, in the units of profiles, that is damage whichever coefficient it is of."""

SO_FAR = "bands are about the best so far, and may be too wide or too narrow"
"""What to know of particles whose drawing was stopped."""

STOPPED = f"the drawing of the particles was stopped before its end (mmgtune posterior): {SO_FAR}"
"""The same as a note of what they were used for."""

AIR_AND_WAVES = ("wind", "waves", "wave-drift")
"""Effects of what was around the ship that are forces."""


@dataclass(frozen=True, eq=False)
class Particles:
    """Equally probable columns of coefficients.

    profile  with every effect that any particle has; its own values are the most probable ones
    names    of the numbers that differ between particles
    values   (n_names, n_particles) in the profile's units
    facts    what they were made from, for JSON
    """

    profile: ShipProfile
    names: tuple[str, ...]
    values: FloatArray
    facts: Mapping[str, Any]

    def __len__(self) -> int:
        return int(self.values.shape[1])

    def __repr__(self) -> str:
        """In a line."""
        return f"Particles({self.profile.id}: {len(self)} of {len(self.names)} numbers)"

    @property
    def interrupted(self) -> bool:
        """Whether their drawing was stopped before its end."""
        return self.facts.get("interrupted") is True

    @property
    def doubted(self) -> tuple[str, ...]:
        """What a reader of anything that is made with them must know, in words."""
        return (STOPPED,) if self.interrupted else ()

    def of_the_day(self) -> tuple[str, ...]:
        """Names of what belongs to the trials and not to the ship: current, wind, waves and faults of sensors."""
        sections = self.profile.sections
        found = []
        for name in self.names:
            effect = sections[split_name(name)[0]].component
            around = isinstance(effect, (FilterEffect, FlowEffect, SensorEffect)) or effect.tag in AIR_AND_WAVES
            found += [name] if around else []
        return tuple(found)

    def predictor(self, integrator: Integrator = Integrator(), *, as_logged: bool = False) -> ParticlePredictor:
        """The ship as a predictor that can be asked for particles.

        as_logged  in the surroundings and by the sensors of the trials; else the ship alone, both as in the profile
        """
        require_usable(self)
        model = Model(self.profile if as_logged else self.without_the_day())
        return ParticlePredictor(model, model.matrix(), integrator, particles=self, as_logged=as_logged)

    def without_the_day(self) -> ShipProfile:
        """The most probable ship in what the profile had around her before any trial was seen."""
        before: dict[str, dict[str, float]] = {}
        for name in self.of_the_day():
            value = self.profile.coefficient(name).pre_determined
            if value is not None:
                before.setdefault(effect_tag(name), {})[split_name(name)[1]] = float(value)
        return with_effects(self.profile, before, "as before the trials") if before else self.profile


@dataclass(frozen=True, eq=False)
class ParticlePredictor(PhysicsPredictor):
    """The most probable coefficients as its one member, and particles on demand; see ``Uncertain``."""

    particles: Particles | None = None
    as_logged: bool = False

    @property
    def id(self) -> str:
        """Id of the ship."""
        return self.model.profile.id

    @property
    def doubted(self) -> tuple[str, ...]:
        """What is doubted of the particles."""
        return self.particles.doubted if self.particles is not None else ()

    @property
    def holds(self) -> int:
        """Particles there are."""
        return len(self.particles) if self.particles is not None else 0

    def drawn(self, n: int, seed: int, sampling: Sampling = "TS-infinity") -> PhysicsPredictor:
        """n particles, none twice where there are as many.

        Raises OptionError for less than one, and for TS1: coefficients of a ship do not change from step to step.
        """
        if n < 1:
            raise OptionError(Problem(f"{n} particles", "particles", fix="write 1 or more"))
        if sampling != "TS-infinity":
            why = "a particle is a ship, and keeps to her coefficients"
            raise OptionError(
                Problem("a physical model has no other particle at each step", "sampling", why, "take TS-infinity")
            )
        assert self.particles is not None  # made by ``Particles.predictor``
        of = self.particles
        rng = np.random.default_rng(seed)
        chosen = rng.permutation(len(of))[:n] if n <= len(of) else rng.integers(len(of), size=n)
        kept = set() if self.as_logged else {*of.of_the_day()}
        at = [k for k, name in enumerate(of.names) if name not in kept]
        theta = self.model.matrix([of.names[k] for k in at], of.values[at][:, chosen])
        return PhysicsPredictor(self.model, theta, self.integrator, self.backend)


def save_particles(particles: Particles, path: Path | str, overwrite: bool = False) -> Path:
    """Write particles as Parquet, a column a number and a row a particle; the profile is in the file.

    Raises OptionError for particles that are no finite numbers, OutputError where the file exists and ``overwrite`` is
    false, or the system refuses to write.
    """
    path = path_of(path)
    must_be_a(particles, Particles, "particles")
    require_usable(particles)
    facts = {"schema": SCHEMA, "profile": particles.profile.text, "facts": dict(particles.facts)}
    columns = dict(zip(particles.names, particles.values, strict=True))
    write_table(path, columns, overwrite=overwrite, metadata={KEY: json.dumps(facts, allow_nan=False).encode()})
    return path


def load_particles(path: Path | str) -> Particles:
    """Read particles: their file, or the run folder that has it.  Raises ProfileError with what is wrong with it."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    must_be_name(path, "file of particles", ProfileError)
    path = in_run(path, PARTICLES) or Path(path)
    try:
        require_regular(path)
        with pq.ParquetFile(path, pre_buffer=False, page_checksum_verification=True) as file:
            rows_of(file.metadata, path.stat().st_size, str(path), ProfileError)
            table = file.read(use_threads=False)
        raw = (table.schema.metadata or {})[KEY]
        facts = parsed(raw)
        text, known, schema = facts["profile"], facts["facts"], facts["schema"]
    except (OSError, pa.ArrowException) as error:
        raise _unusable("particles cannot be read", path, reason(error)) from error
    except RepeatedKey as error:
        raise _unusable("what the particles say of themselves is damaged", path, str(error)) from error
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise _unusable("the file holds no particles", path, "its metadata say of none") from error
    if schema != SCHEMA:
        raise _unusable(f"particles of schema {schema!r:.20}", path, f"this program reads schema {SCHEMA}")
    if not isinstance(text, str) or not isinstance(known, dict):
        raise _unusable("what the particles say of themselves is damaged", path, "it is no profile, or no facts")
    profile = parse_profile(text, path)
    names = tuple(table.column_names)
    there = Model(profile).rows
    unknown = [name for name in names if name not in there]
    floats = all(pa.types.is_floating(column.type) for column in table.columns)
    columns = [plain_numbers(column.combine_chunks()) for column in table.columns] if floats else []
    values = np.array(columns, dtype=float) if columns else np.empty((0, 0))
    if unknown or not names:
        what = f"particles of '{unknown[0][:60]}', which their profile does not have" if unknown else "no particles"
        raise _unusable(what, path, "the file has no columns, or others than were written")
    if len(set(names)) < len(names):
        raise _unusable("a column of the particles is there twice", path, "each number has one column")
    if not floats:
        raise _unusable("particles that are no finite numbers", path, "each column holds floating-point numbers")
    if wrong := _wrong(names, values):
        raise _unusable(wrong[0], path, wrong[1])
    return Particles(profile, names, values, known)


def _wrong(names: tuple[str, ...], values: FloatArray) -> tuple[str, str] | None:
    """What no particles can be, and why; None where they can."""
    if np.ndim(values) != 2 or len(values) != len(names) or not values.size or not np.isfinite(values).all():
        return "particles that are no finite numbers", "each column holds floating-point numbers"
    beyond = np.abs(values).max(axis=1) > LARGEST
    if not beyond.any():
        return None
    return f"particles of '{names[int(np.flatnonzero(beyond)[0])]}' beyond {LARGEST:g}", "no ship has such a number"


def require_usable(particles: Particles) -> None:
    """Raises OptionError for particles in memory that no file of them could hold."""
    if wrong := _wrong(particles.names, particles.values):
        raise OptionError(
            Problem(wrong[0], "particles", wrong[1], "take them as load_particles or posterior gives them")
        )


def _unusable(what: str, path: Path, why: str) -> ProfileError:
    return ProfileError(Problem(what, str(path), why, "copy the file again, or make it anew with mmgtune posterior"))
