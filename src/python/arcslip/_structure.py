"""Structures of one's own: base and damper by functions that tell how they answer to harmonic forces."""

import re

import numpy as np

_STEP = 2e-6  # of eta: resonances of damping ratios down to some 1e-4 are wider
_STENCIL = ((1, 45 / 60), (2, -9 / 60), (3, 1 / 60))  # central differences of sixth order
_AGREE = 1e-5


class Structure:
    """Base and damper by their harmonic responses, as `model` of `[system]` in a case given as a dict.

    `{"system": {"model": beam, "contact_stiffness": 0.5, "preload": 1.0}}`; keys beside these are those of a sector
    but for its matrices and damping: `limit_per_preload`, `force`, `harmonics`, `harmonics_tolerance`,
    `preload_growth`, `wave_number` and `sectors`. Forced responses, peaks, curves and studies take it; `verify`,
    `certify`, stability, nonlinear modes and limit cycles, which need equations of motion, say that they do not.
    Forces and motions are Re(X e^{j eta t}), so that damping makes the imaginary part of a compliance negative.

    Parameters
    ----------
    name : str
        What messages call it: letters, digits and _.
    base : callable
        (eta, wave) -> (C, y0) or (C, y0, dC, dy0): the compliance C (contacts, contacts), motion of the contact of the
        row per force on that of the column, and the motion y0 (contacts,) under the load where `force` is 1; complex.
        With one contact numbers will do. dC and dy0 are derivatives by eta, without which they come from differences
        of sixth order; those that are given are compared with such at first. eta is h times that of the case in the
        h-th harmonic, wave the number of waves n in which that travels, h n modulo `sectors`; 0 without symmetry.
    damper : callable, optional
        (eta, wave) -> C or (C, dC). Without it the contacts are to ground.
    contacts : int
        How many there are.
    base_modes, damper_modes : callable, optional
        (wave) -> frequencies (modes,) or (frequencies, shapes (modes, contacts)): undamped resonances, the shapes of
        unit modal mass. They show where narrow peaks are, which without them a step may pass.
    """

    def __init__(self, name, base, damper=None, *, contacts=1, base_modes=None, damper_modes=None):
        if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
            raise ValueError(f"name: expected a name of letters, digits and _, got {name!r}")
        functions = {"base": base, "damper": damper, "base_modes": base_modes, "damper_modes": damper_modes}
        for key, function in functions.items():
            if not callable(function) and (key == "base" or function is not None):
                raise TypeError(f"structure '{name}': {key}: expected a function, got {function!r}")
        if contacts != int(contacts) or contacts < 1:
            raise ValueError(f"structure '{name}': contacts: expected an integer > 0, got {contacts!r}")
        self.name = name
        self.base = base
        self.damper = damper
        self.contacts = int(contacts)
        self.base_modes = base_modes
        self.damper_modes = damper_modes
        self._checked = set()

    def __repr__(self):
        return f"<arcslip.Structure '{self.name}' of {self.contacts} contacts>"

    def _respond(self, part, eta, wave):
        """What the engine asks for: C by rows, y0, and their derivatives by eta."""
        given = self._call(part, eta, wave)
        count = 2 if part == "base" else 1
        values, slopes = given[:count], given[count:]
        if not slopes:
            slopes = self._differences(part, eta, wave, count)
        elif part not in self._checked:
            self._compare(part, eta, slopes, self._differences(part, eta, wave, count))
        if part == "damper":
            none = np.zeros(self.contacts, complex)
            return values[0].ravel(), none, slopes[0].ravel(), none
        return values[0].ravel(), values[1], slopes[0].ravel(), slopes[1]

    def _differences(self, part, eta, wave, count):
        h = _STEP * eta
        sums = [0] * count
        for k, weight in _STENCIL:
            up, down = self._call(part, eta + k * h, wave), self._call(part, eta - k * h, wave)
            sums = [total + weight * (up[i] - down[i]) / h for i, total in enumerate(sums)]
        return sums

    def _compare(self, part, eta, slopes, differences):
        for name, given, expected in zip(("dC", "dy0"), slopes, differences):
            worst = np.unravel_index(np.argmax(np.abs(given - expected)), given.shape)
            if abs(given - expected)[worst] > _AGREE * np.max(np.abs(expected)):
                raise ValueError(
                    f"structure '{self.name}': {part}: {name}: {given[worst]:.6g} at eta = {eta:.6g}, where "
                    f"differences give {expected[worst]:.6g}"
                )
        self._checked.add(part)

    def _call(self, part, eta, wave):
        """The arrays that a function has returned: C, y0 and perhaps dC, dy0 of the base, C and perhaps dC else."""
        said = f"structure '{self.name}': {part}"
        given = getattr(self, part)(eta, wave)
        if part == "damper" and not isinstance(given, tuple):
            given = (given,)
        allowed = (2, 4) if part == "base" else (1, 2)
        if not isinstance(given, tuple) or len(given) not in allowed:
            what = "(C, y0) or (C, y0, dC, dy0)" if part == "base" else "C or (C, dC)"
            raise ValueError(f"{said}: expected {what}, got {given!r}")
        m = self.contacts
        names = ("C", "y0", "dC", "dy0") if part == "base" else ("C", "dC")
        arrays = []
        for name, one in zip(names, given):
            array = np.asarray(one)
            shape = (m, m) if name.endswith("C") else (m,)
            if array.dtype.kind not in "fiubc":
                raise ValueError(f"{said}: {name}: expected complex numbers, got {array.dtype}")
            if array.shape != shape and not (m == 1 and array.size == 1):
                raise ValueError(f"{said}: {name}: expected shape {shape}, got shape {array.shape}")
            if not np.all(np.isfinite(array)):
                raise ValueError(f"{said}: {name}: {array[~np.isfinite(array)].flat[0]} at eta = {eta:g}")
            arrays.append(array.reshape(shape).astype(complex))
        return arrays

    def _modes(self, part, wave):
        """Frequencies with their shapes."""
        function = getattr(self, f"{part}_modes")
        if function is None:
            return []
        said = f"structure '{self.name}': {part}_modes"
        given = function(wave)
        frequencies, shapes = given if isinstance(given, tuple) else (given, None)
        frequencies = np.atleast_1d(np.asarray(frequencies, dtype=float))
        wanted = (len(frequencies), self.contacts)
        shapes = np.zeros(wanted, complex) if shapes is None else np.asarray(shapes, dtype=complex)
        if frequencies.ndim != 1 or not np.all(np.isfinite(frequencies) & (frequencies >= 0)):
            raise ValueError(f"{said}: expected a row of frequencies >= 0, got {frequencies}")
        if shapes.shape != wanted or not np.all(np.isfinite(shapes)):
            raise ValueError(f"{said}: shapes: expected {wanted} finite numbers, got shape {shapes.shape}")
        return list(zip(frequencies.tolist(), shapes))
