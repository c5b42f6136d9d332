"""Calibrate MMG manoeuvring models of ships against measured trials.

    import mmgtune
    result = mmgtune.fit("suzaku", "suzaku", mmgtune.FitOptions(a_r=0.5))
    print(result.verdict())

What there is stands in ``__init__.pyi``: what the commands call, imported when first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
