"""All candidates fitted to one log, the one chosen, and what follows: the result and its words."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.damping.candidates.candidate import Candidate
from hersey.damping.candidates.collapse import HerseyCollapse
from hersey.damping.candidates.energy import CALORIE, ActivationEnergies, scaled
from hersey.damping.candidates.errors_in_variables import OrthogonalFit
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.intervals import METHODS, Band, ParameterEstimate, band
from hersey.damping.candidates.lack_of_fit import LackOfFit
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.shared_load import SharedLoadLaw
from hersey.damping.estimate import Estimate
from hersey.errors import ParameterError, UntoldWarning
from hersey.result import Result, json_record
from hersey.units import convert, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Units in which people read a quantity, by the unit it is kept in.
_SHOWN = {"rad/s": "rpm", "m": "um"}
#: Candidates listed beside the one chosen.
RUNNERS_UP = 3


@dataclass(frozen=True)
class CandidateFit:
    """A candidate as fitted to the data of a comparison."""

    candidate: Candidate
    fit: LawFit
    not_identified: dict[str, str]
    delta_aicc: float  #: to the least of all candidates
    delta_bic: float
    weight: float  #: Akaike weight
    cross_validation: float | None  #: relative error of excluded dwells, root mean square
    left_out: FloatArray | None  #: ln(measured/predicted) of each dwell from the others
    lack_of_fit: LackOfFit  #: whether its residuals still depend on speed or temperature


@dataclass(frozen=True, repr=False)
class ModelComparison(Result):
    """All models by AICc, those refused and why, and the one chosen with its parameters."""

    candidates: tuple[CandidateFit, ...]
    refused: tuple[tuple[str, str], ...]  #: name and reason
    chosen: CandidateFit
    reasons: tuple[str, ...]
    parameters: tuple[ParameterEstimate, ...]  #: of the candidate chosen
    energies: ActivationEnergies
    collapse: HerseyCollapse | None
    orthogonal: OrthogonalFit
    data: Observations
    bootstrap: int
    seed: int
    version: str = _core.VERSION

    @property
    def runners_up(self) -> tuple[CandidateFit, ...]:
        """The models next in AICc."""
        return tuple(r for r in self.candidates if r is not self.chosen)[:RUNNERS_UP]

    def candidate(self, key: str) -> CandidateFit:
        """Return a model by its key, e.g. ``arrhenius/two-hersey``."""
        for candidate in self.candidates:
            if candidate.candidate.key == key:
                return candidate
        known = ", ".join(r.candidate.key for r in self.candidates)
        raise ParameterError(f"no model '{key}' was fitted. Use one of {known}")

    @takes_si(speed="speed", temperature="temperature")
    def predict(self, *, speed: FloatArray | float, temperature: FloatArray | float | None = None) -> Band:
        """Return torque (N m) with its bands at speeds (rad/s) and temperatures (K), broadcast together."""
        speeds = np.atleast_1d(np.asarray(speed, dtype=np.float64))
        law = self.chosen.fit.law
        if (law.thermal is not None or isinstance(law, SharedLoadLaw)) and temperature is None:
            raise ParameterError("this model depends on temperature. Give the temperature in K")
        hot = None
        if temperature is not None:
            speeds, hot = np.broadcast_arrays(speeds, np.asarray(temperature, dtype=np.float64))
        if self.chosen.fit.law.thermal is not None and self.chosen.fit.not_estimable("e"):
            warnings.warn(UntoldWarning(), stacklevel=4)
        return band(self.chosen.fit, self.data.at(speeds, hot))

    def summary(self) -> str:
        """Return the comparison as text."""
        return _summary(self)

    def headline(self) -> str:
        """Return the chosen model and the number of models."""
        return f"{self.chosen.candidate.name}, chosen among {len(self.candidates)} models"

    def to_dict(self) -> dict[str, Any]:
        """Return the comparison in SI; energies in J/mol and cal/mol."""
        return json_record(_document(self))

    def to_frame(self) -> pl.DataFrame:
        """Return one row per model."""
        import polars as pl

        rows = [
            {
                "candidate": r.candidate.name,
                "chosen": r is self.chosen,
                "numbers": r.fit.parameters,
                "AICc (1)": r.fit.aicc,
                "dAICc (1)": r.delta_aicc,
                "dBIC (1)": r.delta_bic,
                "weight (1)": r.weight,
                "left out (1)": r.cross_validation,
                "scatter (1)": r.fit.scatter,
                "holds": r.lack_of_fit.holds,
            }
            for r in self.candidates
        ]
        return pl.DataFrame(rows, infer_schema_length=None)


def _summary(comparison: ModelComparison) -> str:
    """Return the table of candidates, the choice with its reasons, and what follows."""
    data = comparison.data
    lines = [
        f"[[Models]]  (same dwells and robust likelihood of ln {data.domain.quantity}; parameters include "
        "the scatter)",
        f"    {'model':<66} {'parameters':>10} {'dAICc':>8} {'dBIC':>8} {'CV error':>9} {'scatter':>8}",
    ]
    lines += [_row(r, chosen=r is comparison.chosen) for r in comparison.candidates]
    lines += [f"    not fitted: {name}: {why}" for name, why in comparison.refused]
    lines += ["[[Choice]]", *(f"    {reason}" for reason in comparison.reasons)]
    lines.append("[[Parameters]]  95 % intervals")
    for parameter in comparison.parameters:
        lines += _parameter_lines(parameter)
    counted = f"{comparison.bootstrap} fits resampled by {data.clustered_by}, seed {comparison.seed}"
    none = "not requested, or most resamples lack a temperature"
    lines.append(f"    (bootstrap: {counted if comparison.bootstrap else none})")
    lines.append(f"    {comparison.orthogonal.verdict}")
    if data.inputs.kelvin is not None:
        lines += ["[[Activation energy]]", *(f"    {line}" for line in comparison.energies.lines())]
        lines += [_local(kelvin, energy) for kelvin, energy in comparison.energies.local]
    if comparison.collapse is not None:
        lines += ["[[Hersey collapse]]", f"    {comparison.collapse.verdict}"]
    return "\n".join(lines)


def _document(comparison: ModelComparison) -> dict[str, object]:
    """Return everything as plain data; energies in J/mol, angles in rad."""
    return {
        "dwells": len(comparison.data),
        "clustered_by": comparison.data.clustered_by,
        "reference_speed": comparison.data.reference_speed,
        "reference_temperature": comparison.data.reference_kelvin,
        "temperatures": comparison.data.temperatures,
        "candidates": [_candidate_document(r) for r in comparison.candidates],
        "refused": [{"name": name, "reason": why} for name, why in comparison.refused],
        "chosen": comparison.chosen.candidate.key,
        "reasons": comparison.reasons,
        "parameters": [_parameter_document(p) for p in comparison.parameters],
        "bootstrap": {"draws": comparison.bootstrap, "seed": comparison.seed},
        "errors_in_variables": _picked(comparison.orthogonal, "share largest_shift converged verdict"),
        "activation_energy": _energy_document(comparison.energies),
        "hersey_collapse": None
        if (c := comparison.collapse) is None
        else _picked(c, "collapses deviation scatter p_value overlap verdict") | {"log_viscosity": c.shifts},
    }


def _row(r: CandidateFit, *, chosen: bool) -> str:
    missed = "-" if r.cross_validation is None else f"{100 * r.cross_validation:.2f} %"
    mark = "*" if chosen else " "
    lost = "  not determined" if r.not_identified else ""
    lost += "" if r.lack_of_fit.holds else "  rejected"
    return (
        f"  {mark} {r.candidate.name:<66} {r.fit.parameters:>10} {r.delta_aicc:>8.1f} {r.delta_bic:>8.1f} "
        f"{missed:>9} {100 * r.fit.scatter:>6.2f} %{lost}"
    )


def _parameter_lines(p: ParameterEstimate) -> list[str]:
    unit = _SHOWN.get(p.unit, p.unit)
    if p.not_identified:
        return [f"    {p.name}: cannot be determined: {p.not_identified}"]
    lines = [f"    {p.name} = {_in(p.value, p):.6g} {unit}".rstrip()]
    for method in METHODS:
        if method in p.intervals:
            low, high = (_in(end, p) for end in p.intervals[method])
            lines.append(f"        {method:<11} [{low:.6g}, {high:.6g}]")
    return lines


def _in(value: float, p: ParameterEstimate) -> float:
    return convert(value, p.unit, _SHOWN[p.unit]) if p.unit in _SHOWN else value


def _local(kelvin: float, energy: float) -> str:
    return (
        f"    chosen model, apparent energy of torque at {convert(kelvin, 'K', 'degC'):.0f} degC: "
        f"{energy / 1e3:.4g} kJ/mol = {energy / CALORIE:.0f} cal/mol"
    )


def _picked(of: object, names: str) -> dict[str, object]:
    """Some of the fields of a result, by name."""
    return {name: getattr(of, name) for name in names.split()}


def _candidate_document(r: CandidateFit) -> dict[str, object]:
    return {
        **_picked(r.candidate, "key name"),
        "parameters": dict(zip(r.fit.law.names, r.fit.values.tolist(), strict=True)),
        **_picked(r, "not_identified delta_aicc delta_bic cross_validation lack_of_fit"),
        **_picked(r.fit, "aicc bic scatter"),
        "akaike_weight": r.weight,
        "shared_scatter": r.fit.shared,
    }


def _parameter_document(p: ParameterEstimate) -> dict[str, object]:
    value = None if p.not_identified else p.value
    return {**_picked(p, "name unit error intervals not_identified"), "value": value}


def _energy_document(e: ActivationEnergies) -> dict[str, object]:
    def each(energy: Estimate | None) -> dict[str, object] | None:
        if energy is None:
            return None
        return {"joule_per_mol": vars(energy), "calorie_per_mol": vars(scaled(energy, 1.0 / CALORIE))}

    return {
        "torque": each(e.torque),
        "power": None if e.power is None else vars(e.power),
        "viscosity": each(e.viscosity),
        "transition": each(e.transition),
        **_picked(e, "p_value verdict"),
        "local": [{"temperature": kelvin, "joule_per_mol": energy} for kelvin, energy in e.local],
    }
