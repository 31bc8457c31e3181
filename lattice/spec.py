"""FILE: a model and its two fugacities, in TOML or JSON.

    family = "charge"                 # or "internal-state"
    z1 = 0.7                          # fugacity left of the shock; may be left out where the
    z2 = 0.91                         # boundary rates fix it
    [rates]                           # w24, w42, ... or, for internal-state, h1.., r1.., c
    w42 = 1.0
    [left]                            # alpha1..3, gamma1..3: 1 is 0 -> 1, 2 is 0 -> 2, 3 is 1 -> 2
    alpha1 = 0.3                      # for alpha, the reverse for gamma
    [right]                           # delta1..3 and beta1..3 likewise
    beta1 = 0.2

States are numbered as in the paper: A, vacant, B in the charge family, vacant, A, B in the
internal-state family.  Rates left out are zero.  Without `left` and `right` the chain is a ring.
"""

from __future__ import annotations

import json
import math
import reprlib
import tomllib
from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from lattice.models import LatticeGas, RateError, charge_gas, internal_state_gas
from lattice.shocks import boundary_fugacity

LARGEST = 2**20  # bytes of FILE
SCALE = 1e12  # of rates and fugacities, or their inverse


def _in_scale(value: float) -> float:
    if math.isfinite(value) and value and not 1 / SCALE <= abs(value) <= SCALE:
        raise ValueError(f"must be 0, or between {1 / SCALE:g} and {SCALE:g}")
    return value


Rate = Annotated[float, Field(strict=True), AfterValidator(_in_scale)]
Fugacity = Annotated[
    float, Field(strict=True, ge=0, allow_inf_nan=False), AfterValidator(_in_scale)
]


class SpecError(ValueError):
    """A FILE that does not describe a model; the message names file, field and rule."""


class LatticeFile(BaseModel):
    """Contents of FILE; see the module's docstring.  Rates in inverse units of time."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    family: Literal["charge", "internal-state"]
    rates: dict[str, Rate]
    left: dict[str, Rate] | None = None
    right: dict[str, Rate] | None = None
    z1: Fugacity | None = None
    z2: Fugacity | None = None

    def gas(self) -> LatticeGas:
        """The model; raises `RateError`."""
        build = charge_gas if self.family == "charge" else internal_state_gas
        return build(self.rates, self.left, self.right)

    def fugacities(self, model: LatticeGas) -> tuple[float, float]:
        """(z1, z2), from the boundary rates where not given; raises `RateError`."""
        if model.periodic:
            if self.z1 is None:
                raise RateError("z1 is missing: a ring has no boundary rates that fix it")
            return self.z1, self.z1 if self.z2 is None else self.z2
        z1 = boundary_fugacity(model, "left") if self.z1 is None else self.z1
        z2 = boundary_fugacity(model, "right") if self.z2 is None else self.z2
        return z1, z2


def read(path: Path) -> tuple[LatticeGas, float, float]:
    """Model and fugacities (z1, z2) of a TOML or (suffix .json) JSON file.

    Raises `SpecError`, whose one-line message starts with the path, on anything wrong with it.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise SpecError(f"{path}: more than {LARGEST} bytes")
        text = path.read_text(encoding="utf-8")
        data = json.loads(text) if path.suffix.lower() == ".json" else tomllib.loads(text)
        spec = LatticeFile.model_validate(data)
        model = spec.gas()
        return (model, *spec.fugacities(model))
    except SpecError:
        raise
    except ValidationError as error:
        raise SpecError(f"{path}: {_sentences(error)}") from error
    except OSError as error:
        raise SpecError(f"{path}: {error.strerror or error}") from error
    except RateError as error:
        raise SpecError(f"{path}: {error}") from error
    except RecursionError as error:
        raise SpecError(f"{path}: nested too deep") from error
    except (ValueError, ArithmeticError) as error:
        raise SpecError(f"{path}: not readable as {path.suffix[1:] or 'TOML'}: {error}") from error


def _sentences(error: ValidationError) -> str:
    parts = []
    for issue in error.errors():
        where = ".".join(str(step) for step in issue["loc"]) or "file"
        given = "" if issue["type"] == "missing" else f" (given {_shown(issue['input'])})"
        parts.append(f"{where}: {issue['msg'].lower()}{given}")
    return "; ".join(parts)


def _shown(value: object) -> str:
    try:
        return reprlib.repr(value)
    except ValueError:  # an integer of more digits than Python prints
        return f"a {type(value).__name__}"
