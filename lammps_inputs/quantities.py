"""Quantities with units, as scene files and the command line have them."""

from functools import cache
from tokenize import TokenError
from typing import Any

import pint


@cache
def _units() -> Any:
    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True)  # for degC


def si(value: object, unit: str) -> float:
    """A quantity such as "0.4 um" or "20 mV" as a number in a unit, which plain numbers are in.

    Raises:
        ValueError: naming the value, its dimension and the one asked for.
    """
    if isinstance(value, int | float):
        try:
            return float(value)
        except OverflowError:
            raise ValueError("must be a finite number") from None
    if not isinstance(value, str):
        raise ValueError(f"must be a number in {unit} or a quantity such as '1 {unit}'")
    shown = value if value.isprintable() else repr(value)
    try:
        quantity = _units().Quantity(value)
        if quantity.dimensionless and unit:
            return float(quantity.magnitude)
        return float(quantity.to(unit).magnitude)
    except pint.DimensionalityError as error:
        raise ValueError(
            f"{shown}: is a quantity of {error.dim1}, must be one of {error.dim2} such as 1 {unit}"
        ) from None
    except (pint.PintError, TokenError, TypeError, AttributeError, ValueError) as error:
        raise ValueError(f"{shown}: not a quantity in {unit}: {error}") from None
