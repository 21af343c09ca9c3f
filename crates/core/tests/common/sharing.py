"""Reference numbers of tests/mixed.rs, with 40 digits by bisection: python sharing.py (needs mpmath).

Written from docs/theory/mixed.md, without the equations by which the core solves the law.
"""

from mpmath import diff, exp, gamma, log, mp, mpf, pcfd, pi, sqrt

mp.dps = 40
SOFT = dict(
    reference=mpf("0.02"), film=mpf("0.6"), edge=mpf(8), roundness=mpf("0.7"), stiffness=mpf(20),
    boundary=mpf(30), shear=mpf(1), rolling=mpf("0.1"), rolling_exponent=mpf("0.8"),
)  # fmt: skip


def moment(order, lam):
    """Return int_lam^inf (z - lam)^order phi(z) dz."""
    return gamma(order + 1) / sqrt(2 * pi) * exp(-lam * lam / 4) * pcfd(-order - 1, lam)


def asperities(law, lam):
    """Return the pressure of the asperities over the mean pressure, and n."""
    whole = moment(mpf(5) / 2, lam)
    return law["stiffness"] * whole, lam * mpf(5) / 2 * moment(mpf(3) / 2, lam) / whole


def raised(law, lam, x):
    """Return lambda/lambda_free."""
    pressure, n = asperities(law, lam)
    k = law["roundness"]
    square = (pressure / (mpf(3) / 2 - (mpf(3) / 2 - 4 / pi) * k)) ** 2
    root = sqrt(k * k + 4 * (1 - k) * square)
    slope = sqrt(1 - (root - k) / (2 * (1 - k))) * root / k
    a = law["edge"] * pressure * x ** (-law["film"] / 3)
    return (1 + (mpf("3.89") * a / (slope * (n + mpf("2.84")))) ** mpf("1.34")) ** (mpf("0.5") / mpf("1.34"))


def bisect(rising, low, high):
    """Return the root of a rising function."""
    for _ in range(170):
        middle = (low + high) / 2
        low, high = (low, middle) if rising(middle) > 0 else (middle, high)
    return (low + high) / 2


def dry(law):
    """Return lambda at rest."""
    most = mpf(3) / 2 - (mpf(3) / 2 - 4 / pi) * law["roundness"]
    return bisect(lambda lam: most - asperities(law, lam)[0], mpf("1e-9"), mpf(20))


def solved(law, x):
    """Return lambda at X."""
    free = x ** law["film"]
    low = dry(law) * (1 + mpf("1e-35"))
    return bisect(lambda lam: lam - free * raised(law, lam, x), low, max(mpf(60), 2 * free))


def state(law, x):
    """Return lambda, the least film, the share and the force at X."""
    lam = solved(law, x)
    pressure, n = asperities(law, lam)
    most = mpf(3) / 2 - (mpf(3) / 2 - 4 / pi) * law["roundness"]
    film = (1 - pressure / most) ** most
    least = lam * (1 - mpf("0.21") / (1 + mpf("3.82") * pressure * n) ** mpf("0.58"))
    force = (
        law["boundary"] * (1 - film)
        + law["shear"] * x / lam
        + law["rolling"] * x ** law["rolling_exponent"] * film
    )
    return lam, least, 1 - film, force


def transition(law):
    """Return ln of the product at which the force is least, about X = 10."""
    slope = lambda x: diff(lambda z: state(law, exp(z))[3], x, h=mpf("1e-12"))  # noqa: E731
    low, high = log(law["start"] / 4), log(law["start"] * 4)
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (low, middle) if slope(middle) > 0 else (middle, high)
    return (low + high) / 2


if __name__ == "__main__":
    for x in ("0.001", "0.1", "2", "5", "10", "40"):
        x = mpf(x)
        found = state(SOFT, x)
        slope = diff(lambda each: state(SOFT, each)[3], x, h=x * mpf("1e-12")) / SOFT["reference"]
        print(*(mp.nstr(each, 17) for each in (x, *found, slope)))
    best = min((state(SOFT, mpf(2) ** (mpf(i) / 4))[3], mpf(2) ** (mpf(i) / 4)) for i in range(30))[1]
    law = SOFT | {"start": best}
    turn = transition(law)
    print(
        "transition",
        mp.nstr(law["reference"] * exp(turn), 17),
        *(mp.nstr(e, 17) for e in state(law, exp(turn))),
    )
    for name in SOFT:
        ends = []
        for sign in (-2, -1, 1, 2):
            changed = law | {name: law[name] * (1 + sign * mpf("1e-4"))}
            ends.append(log(changed["reference"]) + transition(changed))
        print(name, mp.nstr((8 * (ends[2] - ends[1]) - (ends[3] - ends[0])) / mpf("12e-4"), 12))
