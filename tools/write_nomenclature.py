"""Write ``docs/nomenclature.md``: every coefficient there is, from the list of components.

python tools/write_nomenclature.py
"""

from __future__ import annotations

from pathlib import Path

from mmgtune.components import COMPONENTS, Component
from mmgtune.effects import BUILT_IN, Parameter
from mmgtune.files import write_text

HEAD = """# Nomenclature

Written by `tools/write_nomenclature.py` from `mmgtune/components`. Symbols are those of the papers in plain
letters; a trailing `_` stands for the prime. "prime" means dimensionless in the prime system of the MMG standard
method; a dash means a pure number. A profile names a coefficient by its section, a target by `section.symbol`.

| quantity | symbol | unit | positive |
|---|---|---|---|
| position of midship | `x`, `y` | m | north, east |
| heading | `psi` | rad | clockwise from north, unwrapped |
| velocity in ship axes at midship | `u`, `v_m` (`v` in files) | m/s | forward, to starboard |
| yaw rate | `r` | rad/s | to starboard |
| drift angle atan2(-v_m, u) | `beta` | rad | bow to starboard of the path |
| propeller revolutions | `n` | 1/s | ahead |
| rudder angle | `delta` | rad | turns the ship to starboard |
| half width of the box | `a_r` | - | share of the pre-determined value |
"""


EFFECTS = """
## Effects

What can differ between a ship and her model. A profile has them as tables `[effects.<tag>]`, a target names a
parameter as `effects.<tag>.<symbol>`. They act in this order of the data flow. The last column says what limits the
range in which a search looks for a parameter.
"""


def nomenclature() -> str:
    """The page."""
    parts = [HEAD]
    for component in COMPONENTS:
        parts.append(f"\n## {component.kind}, model `{component.tag}`: {component.title}\n\n")
        parts += table(component)
    parts.append(EFFECTS)
    for effect in BUILT_IN:
        parts.append(f"\n### effects.{effect.tag} ({effect.place}): {effect.title}\n\n")
        parts += table(effect)
    return "".join(parts)


def table(component: Component) -> list[str]:
    """Sources and fields of a component or effect."""
    parts = [f"{'; '.join(component.cites)}\n\n"] if component.cites else []
    searched = any(isinstance(field, Parameter) for field in component.fields.values())
    heads = (
        "symbol",
        "unit",
        "meaning",
        "where a profile leaves it out",
        *(("limit of the search",) if searched else ()),
    )
    parts.append(f"| {' | '.join(heads)} |\n|{'---|' * len(heads)}\n")
    for symbol, field in component.fields.items():
        default = "must be given" if field.default is None else f"{field.default:g}"
        if field.choices:
            default = next(word for word, value in field.choices.items() if value == field.default)
        label = field.label.replace("|", "\\|")
        limit = f" {field.bounds_source or '-'} |" if isinstance(field, Parameter) else ""
        parts.append(f"| `{symbol}` | {field.unit} | {label} | {default} |{limit}\n")
    return parts


if __name__ == "__main__":
    write_text(Path(__file__).parent.parent / "docs" / "nomenclature.md", nomenclature())
