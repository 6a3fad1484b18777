"""Elements of one's own: forces written in Python that act beside the contacts of a case."""

import re

import numpy as np

from ._cycle import changes_by_differences, check_cycle, complex_changes

_TINY = 1e-30


class Element:
    """A force f(x) of the displacement x, odd, f(-x) = -f(x), as a kind of `[[element]]`.

    In a case given as a dict it stands where the name of a kind would, with its settings beside it:
    `{"element": [{"kind": soft, "at": "base", "k": 3.0}]}`. All that cases do with elements they do with it, but for
    `verify` and `certify`; a setting may be continued, as `parameter = "soft.k"`. Functions get arrays, copies, and
    are called from the thread that works.

    Parameters
    ----------
    kind : str
        What cases and messages call it: letters, digits and _.
    force : callable
        (x, **settings) -> f, of the shape of x, in the case's unit of force; of the momentary displacements x unless
        it has a memory.
    slope : callable, optional
        (x, **settings) -> df/dx. Without it: complex steps, which are exact, if force takes complex numbers, else
        central differences. One that is given is compared with differences when it is first used.
    settings : dict, optional
        Default of each number that force takes beside x; None where a case has to give it.
    scales_force : sequence of str
        Settings to whose product the force is proportional: of rods and beams they are N times those of a node.
    memory : bool
        Whether the force follows from the way that x has taken, but not from how fast. Then force takes periods of x,
        an array (samples, columns) with a motion in each column, and returns the force in the settled cycle, of the
        same shape; `marched` makes such a function of a law with states. slope takes (x, dx, **settings), both of
        this shape, and returns the change of the force along dx. All motions are odd in half a period,
        x[i + samples/2] = -x[i], and so are the forces; the first sample is the largest one.
    sticks : callable, optional
        (**settings) -> (stiffness, amplitude), with memory: up to this amplitude of x the force is stiffness x, and
        there it has a corner, which is found as a point "switch". Without it corners are passed in small steps.
    samples : int
        In a period, an even number, with memory; at least 8 in that of each harmonic are taken. Harmonics are right
        to some (2 pi/samples)^2 of the force where it has kinks, as of a slider: to 1e-5 with 512 or 1e-6 with 2048.
    """

    def __init__(self, kind, force, slope=None, settings=None, scales_force=(), *, memory=False,
                 sticks=None, samples=512):
        if not isinstance(kind, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", kind):
            raise ValueError(f"kind: expected a name of letters, digits and _, got {kind!r}")
        for name, function in (("force", force), ("slope", slope), ("sticks", sticks)):
            if not callable(function) and (name == "force" or function is not None):
                raise TypeError(f"element '{kind}': {name}: expected a function, got {function!r}")
        if sticks is not None and not memory:
            raise ValueError(f"element '{kind}': sticks: only with memory")
        self.kind = kind
        self.force = force
        self.slope = slope
        self.settings = dict(settings or {})
        unknown = [name for name in scales_force if name not in self.settings]
        if unknown:
            raise ValueError(f"element '{kind}': scales_force: '{unknown[0]}' is none of its settings")
        if samples != int(samples) or samples % 2 or samples < 16:
            raise ValueError(f"element '{kind}': samples: expected an even number >= 16, got {samples!r}")
        self.memory = bool(memory)
        self.sticks = sticks
        self.samples = int(samples)
        self._settings = [
            (name, None if value is None else float(value), name in scales_force)
            for name, value in self.settings.items()
        ]
        self._checked_to = 0.0  # the largest displacement
        self._complex = True

    def __repr__(self):
        return f"<arcslip.Element '{self.kind}' of {', '.join(['x', *self.settings])}>"

    def _sampled(self, x, values, varied, derivatives):
        """What the engine asks for: f; df/dx, (df/ds); with two derivatives f, f', f'', f_s, f'_s, f_ss."""
        if derivatives and self._is_new(x):
            self._check(x, values)
        force = self._call("force", self.force, x, values)
        if not derivatives:
            return [force]
        found = [force, self._slope(x, values)]
        if derivatives > 1:
            step = np.max(np.abs(x), initial=_TINY) * 1e-5
            found.append((self._slope(x + step, values) - self._slope(x - step, values)) / (2 * step))
        if varied < 0:
            return found
        found.append(self._by_setting(self._force_at, x, values, varied))
        if derivatives > 1:
            found.append(self._by_setting(self._slope, x, values, varied))
            found.append(
                self._by_setting(lambda z, v: self._by_setting(self._force_at, z, v, varied), x, values, varied)
            )
        return found

    def _cycle(self, x, ways, values, varied, derivatives):
        """What the engine asks for: the force of a settled cycle; its changes along the rows of ways, (df/ds)."""
        if not derivatives:
            return [self._force_at(x[:, None], values)[:, 0]]
        if self._is_new(x):
            self._complex = check_cycle(self, x, ways.T, values) and self._complex
            if self.sticks is not None:
                self._check_stuck(x, values)
        force, changes = self._along(x, ways.T, values)
        if varied < 0:
            return [force, changes]
        return [force, changes, self._by_setting(self._force_at, x[:, None], values, varied)[:, 0]]

    def _stuck(self, values, varied):
        """Stiffness and amplitude of the stuck range, each with two derivatives by the setting that is continued."""
        if varied < 0:
            return [one for value in self._range(None, values) for one in (value, 0.0, 0.0)]

        def first(_, changed):
            return self._by_setting(self._range, None, changed, varied)

        parts = [self._range(None, values), first(None, values), self._by_setting(first, None, values, varied)]
        return np.transpose(parts).ravel().tolist()

    def _range(self, _, values):
        given = self.sticks(**dict(zip(self.settings, values.tolist())))
        numbers = np.asarray(given, dtype=float)
        if numbers.shape != (2,) or not np.all(np.isfinite(numbers) & (numbers > 0)):
            raise ValueError(f"element '{self.kind}': sticks: expected (stiffness, amplitude), both > 0, got {given!r}")
        return numbers

    def _check_stuck(self, x, values):
        """Refuses a stiffness that is not that of a motion within the stuck range."""
        stiffness, amplitude = self._range(None, values)
        within = 0.5 * amplitude / max(np.max(np.abs(x)), _TINY) * x
        force = self._force_at(within[:, None], values)[:, 0]
        if np.max(np.abs(force - stiffness * within)) > 1e-6 * stiffness * amplitude:
            raise ValueError(
                f"element '{self.kind}': sticks: expected the force {stiffness * within[0]:.6g} at x = {within[0]:.6g}, "
                f"within the amplitude {amplitude:.6g}, got {force[0]:.6g}"
            )

    def _along(self, x, ways, values):
        if self.slope is not None:
            return self._force_at(x[:, None], values)[:, 0], self._slopes_along(x, ways, values)
        return (complex_changes if self._complex else changes_by_differences)(self._force_at, x, ways, values)

    def _slopes_along(self, x, ways, values):
        return self._call("slope", self.slope, np.repeat(x[:, None], ways.shape[1], axis=1), values, ways)

    def _is_new(self, x):
        """Whether it was not checked at displacements as large, where what is not linear shows."""
        largest = np.max(np.abs(x), initial=0)
        if largest <= 2 * self._checked_to:
            return False
        self._checked_to = largest
        return True

    def _call(self, name, function, x, values, *more):
        settings = dict(zip(self.settings, values.tolist()))
        given = np.asarray(function(np.array(x), *map(np.array, more), **settings))
        if given.shape != x.shape:
            raise ValueError(
                f"element '{self.kind}': {name}: expected an array of shape {x.shape}, as x has it, "
                f"got shape {given.shape}"
            )
        if given.dtype.kind not in "fiub" and not (given.dtype.kind == "c" and np.iscomplexobj(x)):
            raise ValueError(f"element '{self.kind}': {name}: expected real numbers, got {given.dtype}")
        wrong = np.flatnonzero(~np.isfinite(given))
        if len(wrong):
            raise ValueError(f"element '{self.kind}': {name}: {given.flat[wrong[0]]} at x = {x.flat[wrong[0]]:g}")
        return given

    def _force_at(self, x, values):
        return self._call("force", self.force, x, values)

    def _slope(self, x, values):
        if self.slope is not None:
            return self._call("slope", self.slope, x, values)
        if self._complex:
            tiny = np.max(np.abs(x), initial=_TINY) * 1e-30
            return self._force_at(x + 1j * tiny, values).imag / tiny
        return self._differences(x, values)

    def _differences(self, x, values):
        """Central differences of fourth order."""
        h = np.max(np.abs(x), initial=_TINY) * 1e-3
        near, far = (self._force_at(x + k * h, values) - self._force_at(x - k * h, values) for k in (1, 2))
        return (8 * near - far) / (12 * h)

    def _by_setting(self, function, x, values, varied):
        h = 1e-4 * max(abs(values[varied]), 1e-8)
        changed = []
        for k in (1, 2):
            up, down = values.copy(), values.copy()
            up[varied] += k * h
            down[varied] -= k * h
            changed.append(function(x, up) - function(x, down))
        return (8 * changed[0] - changed[1]) / (12 * h)

    def _check(self, x, values):
        """Refuses a force that is not odd and a slope that is not its own."""
        if not np.any(x):
            return
        force, mirrored = self._force_at(x, values), self._force_at(-x, values)
        worst = np.argmax(np.abs(force + mirrored))
        if abs(force + mirrored)[worst] > 1e-9 * np.max(np.abs(force)):
            raise ValueError(
                f"element '{self.kind}': force: expected f(-x) = -f(x), got f({x[worst]:.6g}) = {force[worst]:.6g} "
                f"and f({-x[worst]:.6g}) = {mirrored[worst]:.6g}"
            )
        differences = self._differences(x, values)
        self._complex = self._complex and self._takes_complex(x, values, differences)
        if self.slope is not None:
            slope = self._call("slope", self.slope, x, values)
            wrong = np.abs(slope - differences)
            worst = np.argsort(wrong)[len(wrong) // 2]  # a kink or two are no mistake
            if wrong[worst] > 1e-4 * max(np.max(np.abs(differences)), _TINY):
                raise ValueError(
                    f"element '{self.kind}': slope: {slope[worst]:.6g} at x = {x[worst]:.6g}, where differences of "
                    f"force give {differences[worst]:.6g}"
                )

    def _takes_complex(self, x, values, differences):
        tiny = np.max(np.abs(x)) * 1e-30
        try:
            slope = np.asarray(self._force_at(x + 1j * tiny, values)).imag / tiny
        except Exception:
            return False
        return bool(np.median(np.abs(slope - differences)) <= 1e-4 * max(np.max(np.abs(differences)), _TINY))
