"""Elements with a memory: forces over a period, their derivatives, and laws with states as such forces."""

import numpy as np

_SETTLED = 1e-12  # of the state
_DIFFERENCE = 1e-5  # of the largest displacement
_ODD = 1e-6  # of the force, which differs by how far the cycle has settled
_AGREE = 1e-4


def marched(step, state=0.0, *, most_periods=200):
    """A force with memory, for `Element`, from a law with states.

    The law is marched from rest to the motion's largest displacement and from there over half periods until the state
    is what it was, with the other sign, to within 1e-12.

    Parameters
    ----------
    step : callable
        (x, before, state, **settings) -> (force, state): the displacements now and a sample before, arrays with one
        entry for each motion that is marched, and the state. It takes numpy's functions of arrays, as np.minimum and
        np.where, in place of `if`, and is odd: with the signs of all three turned it gives both with theirs turned.
    state : float or sequence of float
        At rest. Of one number the state has the shape of x, of k it is an array (k, motions).
    most_periods : int
        After which a state that has not come back is an error.

    Returns
    -------
    callable
        (x, **settings) -> f, both (samples, motions).

    Examples
    --------
    A spring in series with a slider:

    >>> import arcslip, numpy as np
    >>> def step(x, before, f, k, limit):
    ...     f = np.minimum(np.maximum(f + k * (x - before), -limit), limit)
    ...     return f, f
    >>> slider = arcslip.Element("slider", arcslip.marched(step), settings={"k": None, "limit": None}, memory=True)
    """
    if not callable(step):
        raise TypeError(f"marched: expected a function of x, the x before and a state, got {step!r}")
    at_rest = np.asarray(state, dtype=float)
    if at_rest.ndim > 1:
        raise ValueError(f"marched: state: expected a number or a row of them, got shape {at_rest.shape}")

    def force(x, **settings):
        now = np.zeros((*at_rest.shape, x.shape[1]), x.dtype) + at_rest[..., None]
        half = len(x) // 2
        rise = list(np.linspace(0, 1, half // 2 + 1)[:, None] * x[0])
        _require(step, rise[1], now, settings)
        now = _passed(step, rise, now, settings)[1]
        there, back = list(x[: half + 1]), [*x[half:], x[0]]
        for _ in range(most_periods):
            begin = now
            first, middle = _passed(step, there, begin, settings)
            second, end = _passed(step, back, middle, settings)
            if _is_back(begin, -middle):
                return np.array([second[-1], *first, *second[:-1]])
            now = _extrapolated(begin, -middle, end)
        raise ValueError(
            f"marched: the state has not come back after {most_periods} periods, half a period from {begin} to {middle}"
        )

    return force


def _passed(step, way, state, settings):
    """The forces on a way after its first place, and the state at its end."""
    before, forces = way[0], []
    for one in way[1:]:
        force, state = step(one, before, state, **settings)
        forces.append(force)
        before = one
    return forces, state


def _require(step, x, state, settings):
    """Refuses what a step returns that is no force and state, or that is not odd."""
    given = step(x, 0 * x, state, **settings)
    if not isinstance(given, tuple) or len(given) != 2:
        raise ValueError(f"marched: step: expected a tuple (force, state), got {given!r}")
    mirrored = step(-x, 0 * x, -state, **settings)
    for name, one, other, shape in zip(("force", "state"), given, mirrored, (x.shape, state.shape)):
        if np.shape(one) != shape:
            raise ValueError(f"marched: step: {name}: expected shape {shape}, got shape {np.shape(one)}")
        if np.any(np.abs(one + other) > _ODD * np.abs(one)):
            raise ValueError(
                f"marched: step: {name}: expected {-np.ravel(one)[0]:.6g} for x = {-x[0]:.6g} and the state "
                f"{-np.ravel(state)[0]:.6g}, as it is {np.ravel(one)[0]:.6g} for both without the sign, got "
                f"{np.ravel(other)[0]:.6g}"
            )


def _extrapolated(state, after_one, after_two):
    """By Aitken: over half periods, their sign turned, slow laws alternate round the state that comes back."""
    first, second = after_one - state, after_two - after_one
    change = second - first
    is_good = np.abs(change) >= 0.5 * np.abs(first)
    return np.where(is_good & (change != 0), state - first**2 / np.where(change == 0, 1, change), after_two)


def _is_back(begin, now):
    """Of numbers that complex steps carry both parts, the second less sharply; what is nan is left to others."""
    if not np.all(np.isfinite(now)):
        return True
    parts = [(begin.real, now.real, _SETTLED)]
    if np.iscomplexobj(now):
        parts.append((np.imag(begin), now.imag, 1e3 * _SETTLED))
    return all(np.max(np.abs(b - a), initial=0) <= to * np.max(np.abs([a, b]), initial=0) for a, b, to in parts)


def complex_changes(force, x, ways, values):
    """The force (n) and its changes along the columns of ways (n x d) by complex steps."""
    tiny = np.max(np.abs(x), initial=1e-200) * 1e-30
    given = force(np.column_stack([x + 0j, x[:, None] + 1j * tiny * ways]), values)
    return given[:, 0].real, given[:, 1:].imag / tiny


def changes_by_differences(force, x, ways, values):
    """The same by central differences."""
    h = _DIFFERENCE * np.max(np.abs(x), initial=1e-200)
    up, down = x[:, None] + h * ways, x[:, None] - h * ways
    given = force(np.column_stack([x, up, down]), values)
    count = ways.shape[1]
    return given[:, 0], (given[:, 1 : 1 + count] - given[:, 1 + count :]) / (2 * h)


def check_cycle(element, x, ways, values):
    """Refuses a force that is not odd and a slope that is not its own; tells whether force takes complex numbers."""
    force, differences = changes_by_differences(element._force_at, x, ways, values)
    half = len(x) // 2
    worst = np.argmax(np.abs(force[half:] + force[:half]))
    if abs(force[worst] + force[worst + half]) > _ODD * np.max(np.abs(force)):
        raise ValueError(
            f"element '{element.kind}': force: expected a settled cycle with f(-x) = -f(x), got {force[worst]:.6g} "
            f"at x = {x[worst]:.6g} and {force[worst + half]:.6g} half a period later"
        )
    size = max(np.max(np.abs(differences), initial=0), 1e-200)
    if element.slope is not None:
        slope = element._slopes_along(x, ways, values)
        wrong = np.abs(slope - differences)
        worst = np.unravel_index(np.argsort(wrong, axis=None)[wrong.size * 3 // 4], wrong.shape)  # kinks may differ
        if wrong[worst] > _AGREE * size:
            raise ValueError(
                f"element '{element.kind}': slope: {slope[worst]:.6g} at x = {x[worst[0]]:.6g} along "
                f"{ways[worst]:.6g}, where differences of force give {differences[worst]:.6g}"
            )
    try:
        changes = complex_changes(element._force_at, x, ways, values)[1]
    except Exception:
        return False
    return bool(np.quantile(np.abs(changes - differences), 0.75) <= _AGREE * size)
