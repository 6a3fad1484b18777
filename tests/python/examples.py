"""Small problems that several tests trace."""

import numpy as np

import arcslip


def circle(u, p):
    """u^2 + lambda^2 = 1."""
    return np.array([u[0] ** 2 + p["lambda"] ** 2 - 1])


class Cubic(arcslip.Problem):
    """A fold at u = +-1/sqrt(3): lambda = u - u^3 + mu u."""

    equilibrium = True

    def residual(self, u, p):
        return p["lambda"] - (1 + p["mu"]) * u + u**3

    def jacobian(self, u, p):
        return np.array([[-(1 + p["mu"]) + 3 * u[0] ** 2]])

    def parameter_jacobian(self, u, p):
        return np.array([[1.0, -u[0]]])

    def observables(self, u, p):
        return {"square": u[0] ** 2}


FOLD = 2 / 27**0.5  # of Cubic, its lambda
