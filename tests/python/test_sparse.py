"""Sparse Jacobians from Python."""

import numpy as np
import pytest

import arcslip

pytestmark = pytest.mark.filterwarnings("ignore:asymptotic")  # of lambda = 0, where the branch goes for ever


def sparse_bratu(n, columns=None):
    """u'' + lambda e^u = 0 by differences, with its Jacobian as compressed columns."""
    rows = [[i for i in (j - 1, j, j + 1) if 0 <= i < n] for j in range(n)]
    indices = np.concatenate(rows)
    indptr = np.concatenate([[0], np.cumsum([len(column) for column in rows])])
    diagonal = indices == np.repeat(np.arange(n), np.diff(indptr))
    h2 = 1 / (n + 1) ** 2

    def f(u, p):
        left, right = np.concatenate([[0], u[:-1]]), np.concatenate([u[1:], [0]])
        return left + right - 2 * u + h2 * p * np.exp(u)

    def jacobian(u, p):
        data = np.where(diagonal, -2.0, 1.0)
        data[diagonal] += h2 * p * np.exp(u)
        return columns(data, indices, indptr, p) if columns else (data, indices, indptr)

    return arcslip.Problem(f, jacobian=jacobian, sparse=True)


def test_a_sparse_problem_is_traced_as_a_dense_one():
    branch = arcslip.trace(sparse_bratu(200), np.zeros(200), 0.0, range=(0, 4))
    (fold,) = [point["lambda"] for point in branch.special if point["type"] == "fold"]
    assert fold == pytest.approx(3.513830719, abs=1e-3)
    small = sparse_bratu(9)
    full = arcslip.trace(small.residual, np.zeros(9), 0.0, range=(0, 4))
    sparse = arcslip.trace(small, np.zeros(9), 0.0, range=(0, 4))
    assert sparse.unknowns[-1] == pytest.approx(full.unknowns[-1], abs=1e-8)


def test_matrices_of_scipy_are_sparse_jacobians():
    sparse = pytest.importorskip("scipy.sparse")
    problem = sparse_bratu(50, lambda data, indices, indptr, p: sparse.csc_matrix((data, indices, indptr)).tocsr())
    mine = arcslip.trace(sparse_bratu(50), np.zeros(50), 0.0, range=(0, 4))
    assert arcslip.trace(problem, np.zeros(50), 0.0, range=(0, 4)).unknowns.tobytes() == mine.unknowns.tobytes()


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        (lambda data, indices, indptr, p: data, "^jacobian: expected a sparse matrix, or data, indices and indptr"),
        (lambda data, indices, indptr, p: (data[1:], indices, indptr), "^jacobian: expected indices of"),
        (lambda data, indices, indptr, p: (data, indices + 1, indptr), "^jacobian: expected indices of"),
        (lambda data, indices, indptr, p: (data, indices[::-1], indptr), "^jacobian: expected ascending indices"),
        (lambda data, indices, indptr, p: (data * np.nan, indices, indptr), r"^jacobian: entry \(0, 0\) is nan"),
        (
            lambda data, indices, indptr, p: (np.ones(9), np.arange(9), np.arange(10))
            if p > 1
            else (data, indices, indptr),
            "^jacobian: its pattern is not what it was",
        ),
    ],
)
def test_what_is_wrong_with_a_sparse_jacobian_is_named(columns, said):
    with pytest.raises(ValueError, match=said):
        arcslip.trace(sparse_bratu(9, columns), np.zeros(9), 0.0, range=(0, 4))
    with pytest.raises(ValueError, match="^jacobian: missing; a sparse problem needs it"):
        arcslip.trace(arcslip.Problem(lambda u, p: u - p, sparse=True), np.zeros(9), 0.0)
