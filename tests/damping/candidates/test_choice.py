"""How candidates are ranked, one is chosen, the reasons given, and the comparison as text and plain data."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from hersey.damping.candidates.branched import COULOMB_VISCOUS, FREE, HELD, ONE, Law
from hersey.damping.candidates.candidate import Candidate, all_candidates
from hersey.damping.candidates.collapse import temperature_collapse
from hersey.damping.candidates.comparison import (
    CandidateFit,
    ModelComparison,
    _by_cross_validation,
    _energies,
    _reasons,
    choose,
    compare_models,
    ranked,
)
from hersey.damping.candidates.constant_plus import ConstantPlusLaw
from hersey.damping.candidates.energy import activation_energies
from hersey.damping.candidates.errors_in_variables import OrthogonalFit, orthogonal_fit
from hersey.damping.candidates.fitting import fit_law
from hersey.damping.candidates.intervals import ParameterEstimate, band, estimates
from hersey.damping.candidates.lack_of_fit import LackOfFit, lack_of_fit
from hersey.damping.candidates.refits import left_out, resampled
from hersey.damping.candidates.thermal import ARRHENIUS, KELVIN, Thermal
from hersey.errors import InsufficientDataError, ParameterError
from tests.damping.candidates.cases import even, hand_fit, inputs
from tests.damping.candidates.test_comparison import REFERENCE, dwells

R = 8.31446261815324
STRAIGHT = Law(Thermal(KELVIN, REFERENCE), ONE)
VALUES = [0.1, -2.4, -0.7]
DATA = even(STRAIGHT, VALUES)
HOLDS = replace(
    lack_of_fit(fit_law(STRAIGHT, DATA), DATA),
    curvature=0.4,
    exponent_with_temperature=0.5,
    temperature=0.6,
    local_exponents=(-0.7, -0.69),
)
BENT = replace(HOLDS, curvature=0.0004, local_exponents=(-0.9, 0.1))
SIZE = {ONE: VALUES, HELD: [0.1, -2.4, -0.7, -1.2, -0.5], FREE: [0.1, -2.4, -0.7, -1.2, -0.5, 3.0]}


def entry(
    aicc: float,
    *,
    branches: str = ONE,
    bic: float = 0.0,
    lost: str = "",
    missed: np.ndarray | None = None,
    lack: LackOfFit = HOLDS,
) -> CandidateFit:
    """A candidate whose AICc is that much above the least; residuals of dwells left out if given."""
    candidate = Candidate(KELVIN, branches)
    fit = hand_fit(Law(Thermal(KELVIN, REFERENCE), branches), SIZE[branches], points=len(DATA))
    fit = replace(fit, deviance=fit.deviance + aicc - fit.aicc - 100.0)
    rms = None if missed is None else float(np.sqrt(np.mean(missed**2)))
    return CandidateFit(candidate, fit, {"at": lost} if lost else {}, aicc, bic, 0.1, rms, missed, lack)


def test_fits_are_ranked_with_akaike_s_weights() -> None:
    deviances = {ONE: -300.0, HELD: -309.0, FREE: -303.0}
    fits, aicc, bic = [], {}, {}
    n = len(DATA)
    for kind, deviance in deviances.items():
        law = Law(Thermal(KELVIN, REFERENCE), kind)
        fits.append((Candidate(KELVIN, kind), hand_fit(law, SIZE[kind], points=n, deviance=deviance)))
        k = len(SIZE[kind]) + 1
        aicc[kind] = deviance + 2 * k + 2 * k * (k + 1) / (n - k - 1)
        bic[kind] = deviance + k * np.log(n)
    found = ranked(fits, DATA, cross_validate=False)
    order = sorted(aicc, key=lambda kind: aicc[kind])
    assert [r.candidate.branches for r in found] == order
    total = sum(np.exp(-(a - min(aicc.values())) / 2) for a in aicc.values())
    for r in found:
        kind = r.candidate.branches
        assert r.delta_aicc == pytest.approx(aicc[kind] - min(aicc.values()), abs=1e-10)
        assert r.delta_bic == pytest.approx(bic[kind] - min(bic.values()), abs=1e-10)
        weight = np.exp(-(aicc[kind] - min(aicc.values())) / 2) / total
        assert r.weight == pytest.approx(weight, rel=1e-10)
        assert r.cross_validation is None
        assert r.left_out is None
        assert r.not_identified == {}
        assert r.lack_of_fit == lack_of_fit(r.fit, DATA)


def test_dwells_left_out_are_summed_up_where_a_law_predicts_them() -> None:
    fit = fit_law(STRAIGHT, DATA)
    (found,) = ranked([(Candidate(KELVIN, ONE), fit)], DATA, cross_validate=True)
    missed = left_out(fit, DATA)
    assert found.cross_validation == pytest.approx(np.sqrt(np.mean(missed**2)), rel=1e-12)
    assert found.left_out is not None
    assert found.left_out == pytest.approx(missed, abs=0)
    law = Law(Thermal(KELVIN, REFERENCE), ONE, groups=4)
    by_heat = replace(DATA, cluster=DATA.inputs.group)
    each = fit_law(law, by_heat)
    (found,) = ranked([(Candidate(KELVIN, ONE, per_temperature=True), each)], by_heat, cross_validate=True)
    assert found.cross_validation is None
    assert found.left_out is None


def test_a_larger_law_must_be_better_by_six() -> None:
    for gap, simple in ((5.99, True), (6.01, False)):
        small, large = entry(gap), entry(0.0, branches=HELD)
        assert choose((large, small)) is (small if simple else large)
    # of laws with as many numbers the likelier
    near, best = entry(3.0), entry(1.0)
    assert choose((entry(0.0, branches=HELD), best, near)) is best
    assert choose((entry(0.0, branches=HELD), near, best)) is best


def test_a_law_that_is_not_determined_stays_unless_another_is_as_likely() -> None:
    """It stays where none is near, for the truth may be in it."""
    for gap, stays in ((5.99, False), (6.01, True)):
        lost, sound = entry(0.0, lost="too few"), entry(gap, branches=HELD)
        worse = entry(35.0, branches=FREE)
        assert choose((lost, sound, worse)) is (lost if stays else sound)
    assert choose((lost, entry(2.0, branches=HELD, lost="too few"))) is lost


def said(others: list[CandidateFit], chosen: CandidateFit) -> list[str]:
    every = tuple(sorted([*others, chosen], key=lambda r: r.delta_aicc))
    return list(_reasons(every, chosen, DATA))


NAMES = {
    ONE: "power law in K x power of speed, one branch",
    HELD: "power law in K x power of speed, two branches, one Hersey number",
    FREE: "power law in K x power of speed, two branches, free",
}


def test_the_likeliest_is_chosen_and_the_next_is_named() -> None:
    chosen = entry(0.0)
    second, third = entry(2.5, branches=HELD, bic=1.0), entry(7.0, branches=FREE, bic=2.0)
    lost = entry(1.0, branches=FREE, lost="too few")
    bic = [replace(r, fit=replace(r.fit, deviance=r.fit.deviance + 50)) for r in (second, third, lost)]
    assert said(bic, chosen) == [
        f"Chosen: {NAMES[ONE]}, with 4 parameters fitted to 72 dwells.",
        f"Next best is {NAMES[HELD]} (AICc higher by 2.5).",
        "BIC selects the same model.",
    ]
    near = replace(bic[0], delta_aicc=1.99)
    assert said([near], chosen)[1] == (f"Next best is {NAMES[HELD]} (AICc higher by 2.0, not significant).")
    even_two = replace(bic[0], delta_aicc=2.0)
    assert said([even_two], chosen)[1] == f"Next best is {NAMES[HELD]} (AICc higher by 2.0)."
    assert said([bic[2]], chosen) == [said([], chosen)[0], "BIC selects the same model."]


def test_what_the_choice_does_not_determine_and_where_it_fails_is_said() -> None:
    chosen = entry(0.0, lost="too few", lack=BENT)
    assert said([], chosen) == [
        f"Chosen: {NAMES[ONE]}, with 4 parameters fitted to 72 dwells.",
        "Parameter at cannot be determined: too few.",
        "The model is rejected: the local exponent of damping changes from -0.90 at the slowest "
        "speeds to 0.10 at the fastest (p = 0.0004).",
        "BIC selects the same model.",
    ]


def test_likelier_laws_that_were_not_chosen_are_accounted_for() -> None:
    chosen = replace(entry(4.3), delta_bic=3.25)
    best = entry(0.0, branches=HELD)
    lost = entry(1.0, branches=FREE, lost="too few speeds")
    tied = entry(2.4, branches=HELD)
    best = replace(best, fit=replace(best.fit, deviance=-900.0))
    assert said([best, lost, tied], chosen) == [
        f"Chosen: {NAMES[ONE]}, with 4 parameters fitted to 72 dwells.",
        f"{NAMES[HELD]}, with 2 more parameters, fits better (AICc lower by 4.3), but 6 is needed.",
        f"{NAMES[FREE]} fits better (AICc lower by 3.3), but one of its parameters cannot be determined: "
        "too few speeds.",
        f"{NAMES[HELD]}, with 2 more parameters, fits better (AICc lower by 1.9), but this difference is not "
        "significant.",
        f"BIC selects {NAMES[HELD]} (BIC lower by 3.2).",
    ]
    worse = replace(entry(7.0, branches=FREE), fit=entry(7.0).fit)
    assert said([best, worse], chosen)[2] == f"Next best is {NAMES[FREE]} (AICc higher by 2.7)."
    one_more = replace(entry(2.0, branches=HELD), delta_aicc=3.0)
    free = entry(0.9, branches=FREE)
    assert said([free], one_more)[1] == (
        f"{NAMES[FREE]}, with 1 more parameter, fits better (AICc lower by 2.1), but 6 is needed."
    )
    assert "this difference is not significant" in said([replace(free, delta_aicc=1.01)], one_more)[1]
    assert said([replace(free, delta_aicc=1.0)], one_more)[1].endswith("lower by 2.0), but 6 is needed.")


def test_cross_validation_says_whether_another_is_better_beyond_chance() -> None:
    random = np.random.default_rng(1)
    good, bad = 0.02 * random.standard_normal(72), 0.02 * random.standard_normal(72)
    what = (
        "Cross-validation, excluding one level at a time: the chosen model predicts the excluded "
        "dwells with an rms error of "
    )
    best = entry(0.0, missed=0.5 * good)
    assert _by_cross_validation((best, entry(1.0, missed=bad)), best, DATA) == (
        f"{what}{100 * best.cross_validation:.2f} %, the best of all models.",
    )
    # the gain of squares against twice its own standard error over the dwells
    for factor in (0.3, 0.7, 0.8, 0.9, 0.95):
        chosen = entry(0.0, missed=good)
        other = entry(1.0, branches=HELD, missed=factor * np.roll(good, 5))
        gain = good**2 - other.left_out**2  # type: ignore[operator]
        error = np.sqrt(np.sum((gain - gain.mean()) ** 2) / 71) * np.sqrt(72)
        apart = "beyond" if gain.sum() > 2 * error else "within"
        assert _by_cross_validation((chosen, other), chosen, DATA) == (
            f"{what}{100 * chosen.cross_validation:.2f} %; {NAMES[HELD]} with "
            f"{100 * other.cross_validation:.2f} %, a difference {apart} chance.",
        )
    assert _by_cross_validation((entry(0.0), best), entry(0.0), DATA) == ()
    one = entry(0.0, missed=np.zeros(72))
    assert _by_cross_validation((one, entry(1.0)), one, DATA) == (f"{what}0.00 %, the best of all models.",)


@pytest.mark.parametrize(("ratio", "apart"), [(1.99, "within"), (2.01, "beyond")])
def test_beyond_chance_is_two_standard_errors(ratio: float, apart: str) -> None:
    swing = np.tile([1.0, -1.0], 36) * 1e-4
    # mean m of the gains, standard deviation s: 72 m = ratio s sqrt(72)
    mean = ratio * np.std(swing, ddof=1) / np.sqrt(72)
    chosen = entry(0.0, missed=np.sqrt(4e-4 + swing + mean))
    other = entry(1.0, branches=HELD, missed=np.full(72, 0.02))
    assert f"a difference {apart} chance." in _by_cross_validation((chosen, other), chosen, DATA)[0]


def arrhenius(branches: str, aicc: float, lost: str = "", each: bool = False) -> CandidateFit:
    groups = 4 if each else 1
    candidate, law = (
        Candidate(ARRHENIUS, branches, per_temperature=each),
        Law(Thermal(ARRHENIUS, REFERENCE), branches, groups),
    )
    values = {"level": 0.1, "e": 2.8, "q": 0.0, "c_mixed": -1.2, "at": -0.5, "d": -6.0}
    fit = hand_fit(law, [values.get(name, -0.6) for name in law.names], points=len(DATA))
    fit = replace(fit, covariance=fit.covariance * (1 + aicc))
    return CandidateFit(candidate, fit, {"at": lost} if lost else {}, aicc, 0.0, 0.1, None, None, HOLDS)


def test_energies_come_from_the_likeliest_arrhenius_law() -> None:
    chosen, power = arrhenius(HELD, 1.0), entry(0.0)
    held, free, one = arrhenius(HELD, 1.0), arrhenius(FREE, 2.0), arrhenius(ONE, 3.0)

    def expected(best: CandidateFit, other: CandidateFit | None) -> object:
        return activation_energies(best.fit, None if other is None else other.fit, chosen.fit, DATA)

    assert _energies((power, held, free, one), chosen, DATA) == expected(held, free)
    assert _energies((power, arrhenius(FREE, 0.5), held), chosen, DATA) == expected(
        arrhenius(FREE, 0.5), arrhenius(FREE, 0.5)
    )
    # one that is not determined is passed over, unless there is no other
    assert _energies((arrhenius(FREE, 0.5, "few"), held, free), chosen, DATA) == expected(held, free)
    assert _energies((arrhenius(HELD, 0.5, "few"),), chosen, DATA) == expected(arrhenius(HELD, 0.5), None)
    assert _energies((arrhenius(FREE, 0.5, "few"),), chosen, DATA) == expected(arrhenius(FREE, 0.5), None)
    # exponents per temperature have no energy of their own; one branch has no transition
    assert _energies((arrhenius(FREE, 0.5, each=True), held), chosen, DATA) == expected(held, None)
    assert _energies((arrhenius(ONE, 0.5), free), chosen, DATA) == expected(arrhenius(ONE, 0.5), None)
    curve = replace(held, candidate=Candidate(ARRHENIUS, ONE, stribeck=True))
    assert _energies((curve, free), chosen, DATA) == expected(free, free)
    # of friction beside a film only the film has an energy, not the torque
    law = ConstantPlusLaw(Thermal(ARRHENIUS, REFERENCE), 0.0)
    friction = replace(
        held,
        candidate=Candidate(ARRHENIUS, COULOMB_VISCOUS),
        fit=hand_fit(law, [0.1, 2.8, -0.5], points=len(DATA)),
    )
    assert _energies((friction, held, free), chosen, DATA) == expected(held, free)
    assert _energies((friction,), chosen, DATA).torque is None
    assert _energies((power,), chosen, DATA).torque is None


def made(**changes: object) -> ModelComparison:
    """A comparison by hand of three candidates, the second chosen."""
    law = Law(Thermal(KELVIN, REFERENCE), HELD)
    best = entry(0.0, branches=FREE, bic=4.5, lost="too few")
    chosen = entry(1.5, branches=HELD, bic=0.0, missed=np.full(72, 0.0213))
    third = entry(3.25, bic=2.25, lack=BENT)
    energies = activation_energies(arrhenius(HELD, 1.0).fit, arrhenius(FREE, 2.0).fit, chosen.fit, DATA)
    both = {"covariance": (2.0, 3.0), "clustered": (1.5, 3.5), "profile": (2.1, 3.2), "bootstrap": (1.9, 3.1)}
    whole = ModelComparison(
        candidates=(best, chosen, third),
        refused=(("VFT", "needs 3 temperatures"),),
        chosen=chosen,
        reasons=("Because.", "And because."),
        parameters=(
            ParameterEstimate("transition speed", "rad/s", 2.5, 0.25, both),
            ParameterEstimate("c", "", -0.71234567, 0.01, {"covariance": (-0.73, -0.69)}),
            ParameterEstimate("T0", "K", 210.0, None, {}, "no lower bound"),
        ),
        energies=energies,
        collapse=temperature_collapse(DATA),
        orthogonal=OrthogonalFit(np.zeros(5), 0.1, 0.2, True),
        data=DATA,
        bootstrap=30,
        seed=9,
        version="1.2.3",
    )
    assert chosen.fit.law == law
    return replace(whole, **changes)  # type: ignore[arg-type]


def test_candidates_are_found_by_key_and_runners_up_by_rank() -> None:
    found = made()
    best, chosen, third = found.candidates
    assert found.candidate("power-K/two-hersey") is chosen
    assert found.candidate("power-K/one") is third
    assert found.runners_up == (best, third)
    more = replace(found, candidates=(best, chosen, third, entry(4.0), entry(5.0)))
    assert [r.delta_aicc for r in more.runners_up] == [0.0, 3.25, 4.0]
    with pytest.raises(
        ParameterError,
        match=r"^no model 'x' was fitted. Use one of power-K/two-free, power-K/two-hersey, power-K/one$",
    ):
        found.candidate("x")


def test_torque_is_predicted_by_the_law_chosen() -> None:
    found = made(chosen=entry(0.0))
    w = found.data.reference_speed
    expected = band(found.chosen.fit, inputs([np.log(3.0 / w), np.log(6.0 / w)], [410.0, 410.0]))
    got = found.predict(speed=np.array([3.0, 6.0]), temperature=410.0)
    assert got.torque == pytest.approx(expected.torque, rel=1e-12)
    assert got.prediction[1] == pytest.approx(expected.prediction[1], rel=1e-12)
    assert got.torque[0] == pytest.approx(np.exp(0.1 - 2.4 * np.log(410 / 400) + 0.3 * np.log(3.0 / w)))
    hot = found.predict(speed=3.0, temperature=np.array([410.0, 380.0]))
    assert hot.torque == pytest.approx(
        [np.exp(0.1 - 2.4 * np.log(t / 400) + 0.3 * np.log(3.0 / w)) for t in (410.0, 380.0)]
    )
    with pytest.raises(
        ParameterError, match=r"^this model depends on temperature. Give the temperature in K$"
    ):
        found.predict(speed=3.0)
    law = Law(None, ONE)
    fit = hand_fit(law, [0.1, -0.7])
    cold = CandidateFit(Candidate(None, ONE), fit, {}, 0.0, 0.0, 1.0, None, None, HOLDS)
    assert made(chosen=cold).predict(speed=3.0).torque == pytest.approx([np.exp(0.1 + 0.3 * np.log(3.0 / w))])


def test_a_comparison_is_what_its_parts_are() -> None:
    candidates = (Candidate(KELVIN, ONE), Candidate(ARRHENIUS, ONE), Candidate(KELVIN, HELD))
    told: list[tuple[int, int]] = []
    found = compare_models(
        DATA, candidates=candidates, bootstrap=5, seed=3, progress=lambda done, of: told.append((done, of))
    )
    assert told == [(0, 3), (1, 3), (2, 3)]
    assert found.chosen.candidate.key == "power-K/one"
    fit = fit_law(STRAIGHT, DATA)
    assert found.chosen.fit.values == pytest.approx(fit.values, rel=1e-9)
    assert found.parameters == estimates(fit, DATA, draws=resampled(fit, DATA, 5, 3))
    assert (found.bootstrap, found.seed) == (5, 3)
    assert found.refused == ()
    assert found.collapse is not None
    assert found.collapse.p_value == temperature_collapse(DATA).p_value
    assert found.orthogonal.largest_shift == orthogonal_fit(fit, DATA).largest_shift
    assert all(r.cross_validation is not None for r in found.candidates)
    bare = compare_models(DATA, candidates=candidates[:1], bootstrap=0, cross_validate=False)
    assert all("bootstrap" not in p.intervals for p in bare.parameters)
    assert bare.candidates[0].cross_validation is None
    assert bare.reasons == (*found.reasons[:1], "BIC selects the same model.")
    plain = compare_models(DATA, candidates=candidates[:1], cross_validate=False)
    assert (plain.bootstrap, plain.seed) == (300, 1)
    assert plain.candidates[0].left_out is None


def test_a_comparison_refuses_what_it_cannot_do() -> None:
    with pytest.raises(ParameterError, match=r"^bootstrap is -1: it must be at least 0$"):
        compare_models(DATA, bootstrap=-1)
    with pytest.raises(ParameterError, match=r"^seed is -2: it must be at least 0$"):
        compare_models(DATA, seed=-2)
    few = DATA.take(np.arange(4))
    assert all(candidate.refused(few) for candidate in all_candidates())
    with pytest.raises(
        InsufficientDataError,
        match=r"^no model can be fitted\. no temperature x power of speed, one branch: its 2 parameters "
        "need 5 dwells; the log has 4$",
    ):
        compare_models(few)
    cold = dwells(Law(None, ONE), [0.1, -0.7], temperatures=None)
    found = compare_models(cold, candidates=(Candidate(None, ONE), Candidate(KELVIN, ONE)), bootstrap=0)
    assert found.collapse is None
    assert found.refused == (("power law in K x power of speed, one branch", "the log has no temperature"),)


def test_a_comparison_as_text_line_by_line() -> None:
    found = made()
    turn = 30.0 / np.pi  # rpm in a rad/s
    header = "    " + "model".ljust(66) + "parameters".rjust(11) + "dAICc".rjust(9) + "dBIC".rjust(9)
    header += "CV error".rjust(10) + "scatter".rjust(9)
    assert found.collapse is not None
    lines = [
        "[[Models]]  (same dwells and robust likelihood of ln torque; parameters include the scatter)",
        header,
        f"    {NAMES[FREE]:<66}          7      0.0      4.5         -   3.00 %  not determined",
        f"  * {NAMES[HELD]:<66}          6      1.5      0.0    2.13 %   3.00 %",
        f"    {NAMES[ONE]:<66}          4      3.2      2.2         -   3.00 %  rejected",
        "    not fitted: VFT: needs 3 temperatures",
        "[[Choice]]",
        "    Because.",
        "    And because.",
        "[[Parameters]]  95 % intervals",
        f"    transition speed = {2.5 * turn:.6g} rpm",
        f"        covariance  [{2.0 * turn:.6g}, {3.0 * turn:.6g}]",
        f"        clustered   [{1.5 * turn:.6g}, {3.5 * turn:.6g}]",
        f"        profile     [{2.1 * turn:.6g}, {3.2 * turn:.6g}]",
        f"        bootstrap   [{1.9 * turn:.6g}, {3.1 * turn:.6g}]",
        "    c = -0.712346",
        "        covariance  [-0.73, -0.69]",
        "    T0: cannot be determined: no lower bound",
        "    (bootstrap: 30 fits resampled by level, seed 9)",
        f"    {found.orthogonal.verdict}",
        "[[Activation energy]]",
        *(f"    {line}" for line in found.energies.lines()),
    ]
    for kelvin, celsius in ((363.0, 90), (400.0, 127), (453.0, 180)):
        energy = 2.4 * R * kelvin  # of the power law chosen
        lines.append(
            f"    chosen model, apparent energy of torque at {celsius} degC: "
            f"{energy / 1e3:.4g} kJ/mol = {energy / 4.184:.0f} cal/mol"
        )
    lines += ["[[Hersey collapse]]", f"    {found.collapse.verdict}"]
    assert found.summary().split("\n") == lines
    cold = replace(DATA, inputs=replace(DATA.inputs, kelvin=None))
    short = made(bootstrap=0, collapse=None, data=cold).summary().split("\n")
    none = "    (bootstrap: not requested, or most resamples lack a temperature)"
    assert short == [*lines[:18], none, lines[19]]


def test_a_comparison_as_plain_data() -> None:
    found = made()
    plain = found.to_dict()
    _, chosen, _ = found.candidates
    assert plain["dwells"] == 72
    assert plain["clustered_by"] == "level"
    assert plain["reference_speed"] == DATA.reference_speed
    assert plain["reference_temperature"] == 400.0
    assert plain["temperatures"] == [363.0, 393.0, 423.0, 453.0]
    assert plain["refused"] == [{"name": "VFT", "reason": "needs 3 temperatures"}]
    assert plain["chosen"] == "power-K/two-hersey"
    assert plain["reasons"] == ["Because.", "And because."]
    assert plain["bootstrap"] == {"draws": 30, "seed": 9}
    assert plain["candidates"][1] == {  # type: ignore[index]
        "key": "power-K/two-hersey",
        "name": NAMES[HELD],
        "parameters": {"level": 0.1, "e": -2.4, "c": -0.7, "c_mixed": -1.2, "at": -0.5},
        "not_identified": {},
        "aicc": chosen.fit.aicc,
        "bic": chosen.fit.bic,
        "delta_aicc": 1.5,
        "delta_bic": 0.0,
        "akaike_weight": 0.1,
        "cross_validation": pytest.approx(0.0213),
        "scatter": 0.03,
        "shared_scatter": [],
        "lack_of_fit": {k: list(v) if isinstance(v, tuple) else v for k, v in vars(HOLDS).items()},
    }
    assert [r["key"] for r in plain["candidates"]] == [r.candidate.key for r in found.candidates]  # type: ignore[attr-defined]
    assert plain["candidates"][0]["not_identified"] == {"at": "too few"}  # type: ignore[index]
    assert plain["parameters"][0] == {  # type: ignore[index]
        "name": "transition speed",
        "unit": "rad/s",
        "value": 2.5,
        "error": 0.25,
        "intervals": {
            "covariance": [2.0, 3.0],
            "clustered": [1.5, 3.5],
            "profile": [2.1, 3.2],
            "bootstrap": [1.9, 3.1],
        },
        "not_identified": "",
    }
    assert plain["parameters"][2] == {  # type: ignore[index]
        "name": "T0",
        "unit": "K",
        "value": None,
        "error": None,
        "intervals": {},
        "not_identified": "no lower bound",
    }
    assert plain["errors_in_variables"] == {
        "share": 0.2,
        "largest_shift": 0.1,
        "converged": True,
        "verdict": found.orthogonal.verdict,
    }
    c = found.collapse
    assert c is not None
    assert plain["hersey_collapse"] == {
        "collapses": c.collapses,
        "deviation": c.deviation,
        "scatter": c.scatter,
        "p_value": c.p_value,
        "overlap": c.overlap,
        "log_viscosity": c.shifts.tolist(),
        "verdict": c.verdict,
    }
    assert made(collapse=None).to_dict()["hersey_collapse"] is None


def test_energies_as_plain_data() -> None:
    found = made()
    plain, e = found.to_dict()["activation_energy"], found.energies
    assert isinstance(plain, dict)
    assert e.torque is not None
    assert e.torque.freedom == 67.0  # of 72 dwells less five parameters
    for name, energy in (("torque", e.torque), ("viscosity", e.viscosity), ("transition", e.transition)):
        assert energy is not None
        numbers = {"value": energy.value, "error": energy.error, "low": energy.low, "high": energy.high}
        freedom = energy.freedom if np.isfinite(energy.freedom) else None
        assert plain[name]["joule_per_mol"] == numbers | {"freedom": freedom, "systematic": 0.0}
        assert plain[name]["calorie_per_mol"] == {
            **{k: pytest.approx(v / 4.184, rel=1e-12) for k, v in numbers.items()},
            "freedom": freedom,
            "systematic": 0.0,
        }
    assert e.power is not None
    assert plain["power"]["value"] == e.power.value
    assert plain["p_value"] == e.p_value
    assert plain["verdict"] == e.verdict
    assert plain["local"] == [
        {"temperature": t, "joule_per_mol": pytest.approx(2.4 * R * t, rel=1e-12)}
        for t in (363.0, 400.0, 453.0)
    ]
    none = activation_energies(None, None, found.chosen.fit, DATA)
    plain = made(energies=none).to_dict()["activation_energy"]
    assert isinstance(plain, dict)
    assert plain["torque"] is plain["power"] is plain["viscosity"] is plain["transition"] is None
    assert plain["local"] == []
