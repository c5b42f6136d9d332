"""Calibrate MMG manoeuvring models of ships against measured trials.

    import mmgtune
    result = mmgtune.fit("suzaku", "suzaku", mmgtune.FitOptions(a_r=0.5))
    print(result.sentence())

What there is stands in ``__init__.pyi``: what the commands call, imported when first used.
"""

from .displayed import displayed_by

_front = None


def _notebook():  # type: ignore[no-untyped-def]
    """What shows results in notebooks, imported when something is first looked at."""
    from . import notebook

    return notebook


displayed_by(_notebook)


def _attached():  # type: ignore[no-untyped-def]
    """How to get a name, and which there are; imported late, as a command must answer Ctrl-C from its first moment."""
    global _front
    if _front is None:
        import lazy_loader

        _front = lazy_loader.attach_stub(__name__, __file__)
    return _front


def __getattr__(name: str) -> object:
    if name == "__version__":
        from .provenance import own_version

        return own_version()
    get, _, names = _attached()
    if name == "__all__":
        return names
    try:
        return get(name)
    except AttributeError:
        if name.startswith("_"):
            raise
        from .errors import near_to

        near = near_to(name, names)
        raise AttributeError(f"mmgtune has no '{name}'{f'; {near}' if near else ''}") from None


def __dir__() -> list[str]:
    return list(_attached()[2])
