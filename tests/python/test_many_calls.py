"""Ten thousand random calls, sound and wrong: none crashes, and none leaves memory behind."""

import gc
import random
import warnings

import numpy as np

import arcslip


def resident():
    """Bytes of this process in memory."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096


class Oops(Exception):
    pass


def misbehave(random_, n):
    """What a user's function may do in place of what it should; now and then, or from the start."""

    def raises(u):
        raise Oops

    return random_.choice(
        [
            raises,
            lambda u: u * np.nan,
            lambda u: np.zeros(n + 1),
            lambda u: None,
            lambda u: "text",
            lambda u: 1j * u,
            lambda u: u.reshape(-1, 1),
            lambda u: u.astype(object),
            lambda u: np.zeros((n, n, 2))[:, 0, 0][::-1],
            lambda u: u[::-1].astype(np.float32),
            lambda u: {},
            lambda u: np.full(n, np.inf),
        ]
    )


def random_problem(random_):
    n = random_.choice([1, 1, 2, 3])
    shift = 0.2 * np.arange(n)  # folds one after the other
    count = [0]
    trips = random_.randint(0, 300)
    wrong = {name: misbehave(random_, n) for name in random_.sample(["f", "jacobian", "y", "event", "none"], 2)}

    def or_wrong(name, right):
        def function(u, p):
            count[0] += 1
            if name in wrong and count[0] > trips:
                return wrong[name](u)
            return right(u, p)

        return function

    parts = {}
    if random_.random() < 0.5:
        parts["jacobian"] = or_wrong("jacobian", lambda u, p: np.diag(3 * u**2 - 1))
    if random_.random() < 0.5:
        parts["observables"] = or_wrong("y", lambda u, p: {"y": u[0] ** 2})
    if random_.random() < 0.3:
        parts["equilibrium"] = True
    events = {"e": or_wrong("event", lambda u, p: u[0] - 0.3)} if random_.random() < 0.3 else None
    return or_wrong("f", lambda u, p: u**3 - u + p + shift), np.full(n, random_.choice([0.0, -1.2, 5.0])), parts, events


def use(random_, branch):
    """Something that can be done with a branch; what is left of it is kept by the caller."""
    point = random_.randrange(-2, len(branch) + 2)
    return random_.choice(
        [
            lambda: branch[random_.choice(branch.columns + ["none"])],
            lambda: branch.unknowns,
            lambda: branch.tangents[point],
            lambda: branch.special,
            lambda: branch.summary,
            lambda: branch.sample(random_.randint(0, 40)).error,
            lambda: branch.where(random_.random()),
            lambda: branch.curve(),
            lambda: branch.resume(max_points=30),
            lambda: branch.start_from(point, max_points=20),
            lambda: branch.switch(point, max_points=20),
            lambda: branch.continue_in_two(point, "none", (0, 1), max_points=10),
            lambda: branch.checkpoint,
            lambda: branch.eigenvalues,
        ]
    )()


def random_case(random_):
    case = {
        "system": {
            "model": random_.choice(["beams", "rods", "ab", "cusp", "enz", "none", 3]),
            "wave_number": 1,
            "elements": random_.choice([30, 2, -1]),
            "mass_ratio": random_.choice([5.0, 0.0, "a", float("nan")]),
            "frequency_ratio": 4.0,
            "slenderness": 33.3,
            "force": 1.0,
            "preload": 1.0,
        },
        "branch": {"parameter": random_.choice(["eta", "P", "D"]), "from": 0.5, "to": random_.choice([0.6, 0.5])},
    }
    if random_.random() < 0.5:
        case["continuation"] = {"max_points": random_.choice([5, 20, 1])}
    return case


def one_call(random_, kept):
    """Does one thing; what goes wrong has to be an exception that says so."""
    kind = random_.random()
    if kind < 0.4 and kept:
        kept.append(use(random_, kept[random_.randrange(len(kept))]))
    elif kind < 0.8:
        f, u0, parts, events = random_problem(random_)
        kept.append(
            arcslip.trace(f, u0, 0.0, range=(0, random_.choice([1, -1])), max_points=15, events=events, **parts)
        )
    elif kind < 0.85:
        arcslip.check(random_case(random_))
    else:
        kept.extend(arcslip.run(random_case(random_)).branches)


def calls(random_, count):
    kept = []
    outcomes = {}
    for _ in range(count):
        try:
            one_call(random_, kept)
            outcome = "done"
        except (ValueError, TypeError, IndexError, KeyError, AttributeError, Oops) as error:
            outcome = type(error).__name__
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
        kept = [branch for branch in kept[-20:] if isinstance(branch, arcslip.Branch)]
        random_.shuffle(kept)
    return outcomes


def test_ten_thousand_calls_neither_crash_nor_leak():
    random_ = random.Random(1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        calls(random_, 2000)
        gc.collect()
        before, objects = resident(), len(gc.get_objects())
        outcomes = calls(random_, 8000)
        gc.collect()
    assert outcomes["done"] > 2000 and outcomes["Oops"] > 50 and outcomes["ValueError"] > 500
    assert len(gc.get_objects()) - objects < 1000
    assert resident() - before < 8 << 20  # a branch that stayed would be tens of kB
