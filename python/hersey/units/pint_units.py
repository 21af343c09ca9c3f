"""Units that are not in the table: pint reads them."""

from __future__ import annotations

from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any, cast

if TYPE_CHECKING:
    import pint


class _OnFirstUse:
    """The registry of pint, which takes longer to import and fill than many a command to run."""

    def __getattr__(self, name: str) -> Any:
        return getattr(_full_registry(), name)


@cache
def _full_registry() -> pint.UnitRegistry[float]:
    import pint

    full: pint.UnitRegistry[float] = pint.UnitRegistry(autoconvert_offset_to_baseunit=True, cache_folder=None)
    full.define("rev = revolution")
    return full


registry = cast("pint.UnitRegistry[float]", _OnFirstUse())


@lru_cache(maxsize=4096)
def pint_unit(text: str) -> Any:
    """Return the unit of pint, or None if it knows none such."""
    try:
        return registry.parse_units(text)
    except Exception:  # pint raises many kinds, from its tokenizer too
        return None
