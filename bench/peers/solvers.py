"""The public solvers. Each solves one program once, cold, and returns its time.

Packages are imported where they are used, so that a missing package only costs its own line.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import perf_counter_ns
from typing import Any

import numpy as np
from scipy import sparse

from programs import Array, Condensed, Full, Program


@dataclass(frozen=True)
class Answer:
    """A solver's answer to a program."""

    seconds: float
    feasible: bool | None
    """The solver's verdict; `None` if it has no verdict."""
    controls: Array | None
    """All controls in order, if the solver calls the program feasible."""


@dataclass(frozen=True)
class Peer:
    """A solver and a way to use it."""

    name: str
    package: str
    form: str
    clock: str
    """Clock of the times: `native` is the solver's own, `python` is around the call."""
    timed: str
    """Content of the time."""
    runs: int
    solve: Callable[[Program], Answer]


def answer(seconds: float, solved: bool, infeasible: bool, controls: Array) -> Answer:
    """Makes an answer from a solver's report: solved, infeasible or neither."""
    verdict = solved if solved or infeasible else None
    return Answer(seconds, verdict, np.array(controls, dtype=float) if solved else None)


def clarabel(program: Program) -> Answer:
    """Clarabel. Its own time would contain the set-up."""
    import clarabel as package

    form = program.full
    settings = package.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    cones = [package.ZeroConeT(len(form.b)), package.NonnegativeConeT(len(form.h))]
    rows, right = sparse.vstack([form.A, form.G], "csc"), np.concatenate([form.b, form.h])
    solver = package.DefaultSolver(form.P, form.q, rows, right, cones, settings)
    begin = perf_counter_ns()
    solution = solver.solve()
    seconds = (perf_counter_ns() - begin) * 1e-9
    status = str(solution.status)
    solved, infeasible = status.endswith("Solved"), status.endswith("PrimalInfeasible")
    return answer(seconds, solved, infeasible, Full.controls(solution.x))


def cvxopt(options: dict[str, Any], program: Program) -> Answer:
    """CVXOPT's cone solver for quadratic programs."""
    from cvxopt import matrix, spmatrix
    from cvxopt.solvers import qp

    def convert(rows: sparse.csc_matrix) -> spmatrix:
        entries = rows.tocoo()
        return spmatrix(entries.data, entries.row.tolist(), entries.col.tolist(), rows.shape)

    form = program.full
    P, G, A = (convert(rows) for rows in (form.P, form.G, form.A))
    q, h, b = (matrix(vector) for vector in (form.q, form.h, form.b))
    begin = perf_counter_ns()
    result = qp(P, q, G, h, A, b, options={"show_progress": False, **options})
    seconds = (perf_counter_ns() - begin) * 1e-9
    solved, infeasible = (result["status"] == status for status in ("optimal", "primal infeasible"))
    controls = Full.controls(np.array(result["x"]).ravel()) if solved else np.zeros(0)
    return answer(seconds, solved, infeasible, controls)


def daqp(program: Program) -> Answer:
    """DAQP from scratch."""
    import daqp as package

    form = program.condensed
    u, _, flag, info = package.solve(form.H, form.f, form.G, form.h)
    return answer(info["setup_time"] + info["solve_time"], flag == 1, flag == -1, u)


class DaqpModel:
    """DAQP with a workspace that is set up once. It then gets each program's vectors."""

    def __init__(self, with_update: bool) -> None:
        """`with_update`: the time includes the update, which DAQP itself does not time."""
        self.with_update = with_update
        self.form: Condensed | None = None

    def __call__(self, program: Program) -> Answer:
        """Solves a program, starting without active rows."""
        import daqp as package

        form, old = program.condensed, self.form
        fits = old is not None and np.array_equal(old.H, form.H) and np.array_equal(old.G, form.G)
        if not fits:
            self.form, self.model = form, package.Model()
            # These bounds surely hold: DAQP refuses to set up with a row of zeros that does not hold.
            self.model.setup(form.H, form.f, form.G, np.ones(len(form.h)))
        inactive = np.zeros(len(form.h), dtype=np.int32)
        begin = perf_counter_ns()
        self.model.update(f=form.f, bupper=form.h, sense=inactive)
        u, _, flag, info = self.model.solve()
        seconds = (perf_counter_ns() - begin) * 1e-9
        return answer(
            seconds if self.with_update else info["solve_time"], flag == 1, flag == -1, u
        )


def osqp(condensed: bool, program: Program) -> Answer:
    """OSQP. Its usual 4000 iterations would leave many programs unsolved."""
    import osqp as package

    if condensed:
        small = program.condensed
        P, q = sparse.csc_matrix(np.triu(small.H)), small.f
        rows, upper = sparse.csc_matrix(small.G), small.h
        lower = np.full(len(upper), -np.inf)
    else:
        full = program.full
        P, q = full.P, full.q
        rows, upper = sparse.vstack([full.A, full.G], "csc"), np.concatenate([full.b, full.h])
        lower = np.concatenate([full.b, np.full(len(full.h), -np.inf)])
    solver = package.OSQP()
    settings = {"eps_abs": 1e-6, "eps_rel": 1e-6, "max_iter": 100_000, "verbose": False}
    solver.setup(P, q, rows, lower, upper, **settings)
    result = solver.solve(raise_error=False)
    solved, infeasible = (
        result.info.status == status for status in ("solved", "primal infeasible")
    )
    controls = result.x if condensed else Full.controls(result.x)
    return answer(result.info.solve_time, solved, infeasible, controls)


def piqp(backend: str, program: Program) -> Answer:
    """PIQP with one of its KKT solvers."""
    import piqp as package

    dense = backend == "dense_cholesky"
    solver = package.DenseSolver() if dense else package.SparseSolver()
    solver.settings.kkt_solver = getattr(package.KKTSolver, backend)
    solver.settings.compute_timings = True
    if dense:
        form = program.condensed
        solver.setup(form.H, form.f, G=form.G, h_u=form.h)
    else:
        full = program.full
        solver.setup(full.P, full.q, full.A, full.b, full.G, None, full.h)
    status = solver.solve()
    x, info = solver.result.x, solver.result.info
    solved, infeasible = (
        status == known for known in (package.PIQP_SOLVED, package.PIQP_PRIMAL_INFEASIBLE)
    )
    return answer(info.solve_time, solved, infeasible, x if dense else Full.controls(x))


def proxqp(program: Program) -> Answer:
    """ProxQP. With its usual `eps_primal_inf` it would call some feasible programs infeasible."""
    from proxsuite import proxqp as package

    form = program.condensed
    solver = package.dense.QP(len(form.f), 0, len(form.h))
    solver.settings.compute_timings = True
    solver.settings.eps_abs = 1e-8
    solver.settings.eps_primal_inf = 1e-6
    solver.init(form.H, form.f, None, None, form.G, np.full(len(form.h), -np.inf), form.h)
    solver.solve()
    info = solver.results.info
    solved, infeasible = (
        info.status == known
        for known in (package.PROXQP_SOLVED, package.PROXQP_PRIMAL_INFEASIBLE)
    )
    return answer(info.solve_time * 1e-6, solved, infeasible, solver.results.x)


def quadprog(program: Program) -> Answer:
    """quadprog, the Goldfarb-Idnani method. The Hessian is factored before."""
    import quadprog as package

    form = program.condensed
    factor, rows = form.inverse_factor, -form.G.T
    solved, u = True, np.zeros(0)
    begin = perf_counter_ns()
    try:
        u = package.solve_qp(factor, -form.f, rows, -form.h, factorized=True)[0]
    except ValueError as error:
        if "constraints are inconsistent" not in str(error):
            raise
        solved = False
    return answer((perf_counter_ns() - begin) * 1e-9, solved, not solved, u)


TIGHT = {"abstol": 1e-8, "reltol": 1e-9, "feastol": 1e-8}

PEERS = [
    Peer("clarabel", "clarabel", "full sparse", "python", "solve", 3, clarabel),
    Peer("cvxopt", "cvxopt", "full sparse", "python", "set-up, solve", 3, partial(cvxopt, {})),
    Peer(
        "cvxopt-tight", "cvxopt", "full sparse", "python", "set-up, solve", 3,
        partial(cvxopt, TIGHT),
    ),
    Peer("daqp", "daqp", "condensed dense", "native", "set-up, solve", 50, daqp),
    Peer("daqp-model", "daqp", "condensed dense", "native", "solve", 50, DaqpModel(False)),
    Peer(
        "daqp-model-update", "daqp", "condensed dense", "python", "update, solve", 50,
        DaqpModel(True),
    ),
    Peer("osqp", "osqp", "full sparse", "native", "solve", 3, partial(osqp, False)),
    Peer("osqp-condensed", "osqp", "condensed dense", "native", "solve", 3, partial(osqp, True)),
    Peer("piqp", "piqp", "full sparse", "native", "solve", 10, partial(piqp, "sparse_ldlt")),
    Peer(
        "piqp-condensing", "piqp", "full sparse", "native", "solve", 10,
        partial(piqp, "sparse_ldlt_cond"),
    ),
    Peer(
        "piqp-multistage", "piqp", "full sparse", "native", "solve", 10,
        partial(piqp, "sparse_multistage"),
    ),
    Peer(
        "piqp-dense", "piqp", "condensed dense", "native", "solve", 10,
        partial(piqp, "dense_cholesky"),
    ),
    Peer("proxqp", "proxsuite", "condensed dense", "native", "solve", 3, proxqp),
    Peer("quadprog", "quadprog", "condensed dense", "python", "solve", 50, quadprog),
]
