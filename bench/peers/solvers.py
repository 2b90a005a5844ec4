"""The public solvers. Each solves one program once, cold, and returns its time.

Packages are imported where they are used, so that a missing package only costs its own line.
"""

import ctypes
import os
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from time import perf_counter_ns
from typing import Any

import numpy as np
from scipy import sparse

from programs import CONTROLS, STAGES, STATES, Array, Full, Program, TwoSided


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

    form = program.two_sided
    u, _, flag, info = package.solve(form.H, form.f, form.G, form.upper, form.lower)
    return answer(info["setup_time"] + info["solve_time"], flag == 1, flag == -1, u)


class DaqpModel:
    """DAQP with a workspace that is set up once. It then gets each program's vectors."""

    def __init__(self, with_update: bool) -> None:
        """`with_update`: the time includes the update, which DAQP itself does not time."""
        self.with_update = with_update
        self.form: TwoSided | None = None

    def __call__(self, program: Program) -> Answer:
        """Solves a program, starting without active rows."""
        import daqp as package

        form = program.two_sided
        count = len(form.upper)
        if not fits(self.form, form):
            self.form, self.model = form, package.Model()
            # These bounds surely hold: DAQP refuses to set up with a row of zeros that does not hold.
            self.model.setup(form.H, form.f, form.G, np.ones(count), -np.ones(count))
        inactive = np.zeros(count, dtype=np.int32)
        begin = perf_counter_ns()
        refused = self.model.update(f=form.f, bupper=form.upper, blower=form.lower, sense=inactive)
        if refused < 0:
            # Bounds that cross are found by the update.
            return answer((perf_counter_ns() - begin) * 1e-9, False, refused == -1, form.f)
        u, _, flag, info = self.model.solve()
        seconds = (perf_counter_ns() - begin) * 1e-9
        return answer(
            seconds if self.with_update else info["solve_time"], flag == 1, flag == -1, u
        )


def fits(old: TwoSided | None, form: TwoSided) -> bool:
    """Whether a workspace for an older form also serves this one."""
    return old is not None and np.array_equal(old.H, form.H) and np.array_equal(old.G, form.G)


class DaqpNative:
    """DAQP as C programs use it, compiled for this machine. As `DaqpModel`, without Python in its time."""

    def __init__(self) -> None:
        """`source` is the unpacked source of DAQP."""
        self.source: Path | None = None
        self.form: TwoSided | None = None
        self.held = None

    @cached_property
    def library(self) -> ctypes.CDLL:
        """The compiled library."""
        if self.source is None:
            raise ValueError("give DAQP's unpacked source: --daqp FOLDER (README.md)")
        built = Path(tempfile.mkdtemp()) / "daqp.so"
        own = Path(__file__).with_name("daqp_native.c")
        source = self.source / "csrc"
        # The flags of DAQP's own wheel, and the machine's instructions.
        flags = ["-O3", "-march=native", "-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math"]
        files = [own, *sorted(source.glob("src/*.c"))]
        shared = ["-shared", "-fPIC", "-I", source / "include", "-o", built]
        subprocess.run(["cc", *flags, *shared, *files, "-lm"], check=True)
        library = ctypes.CDLL(str(built))
        library.held_new.restype = ctypes.c_void_p
        library.held_free.argtypes = [ctypes.c_void_p]
        library.held_solve.restype = ctypes.c_double
        return library

    def __call__(self, program: Program) -> Answer:
        """Solves a program, starting without active rows."""
        form = program.two_sided
        rows, variables = form.G.shape
        sense, flag = np.zeros(rows, dtype=np.int32), ctypes.c_int()
        if not fits(self.form, form):
            if self.held:
                self.library.held_free(self.held)
            # The workspace keeps pointers to these. The bounds surely hold, as in `DaqpModel`.
            self.form, self.kept = form, [form.H, form.f, form.G, np.ones(rows), -np.ones(rows), sense]
            self.held = self.library.held_new(variables, rows, *map(_pointer, self.kept))
            if not self.held:
                raise ValueError("DAQP cannot set this program up")
        x, multipliers = np.zeros(variables), np.zeros(rows)
        vectors = [form.f, form.upper, form.lower, sense, x, multipliers]
        seconds = self.library.held_solve(
            ctypes.c_void_p(self.held), *map(_pointer, vectors), ctypes.byref(flag)
        )
        return answer(seconds, flag.value == 1, flag.value == -1, x)


def _pointer(array: Any) -> ctypes.c_void_p:
    """The place of an array's numbers, row by row."""
    if not array.flags.c_contiguous:
        raise ValueError("the array is not row by row")
    return ctypes.c_void_p(array.ctypes.data)


DAQP_NATIVE = DaqpNative()


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


def qpoases(program: Program) -> Answer:
    """qpOASES out of CasADi's wheel, from no active row."""
    form = program.condensed  # CasADi refuses two-sided rows whose sides cross
    options = {"printLevel": "none"}
    u, stats = _conic("qpoases", options, _entries(form.H), form.f, _entries(form.G), {"uba": form.h})
    infeasible = "infeasib" in stats["return_status"].lower()
    return answer(stats["t_wall_solver"], stats["success"], infeasible, u)


def hpipm(program: Program) -> Answer:
    """HPIPM out of CasADi's wheel. It has no verdict for infeasible programs; its relative modes reach no tolerance."""
    form, stages = program.full, program.stages
    options = {
        "N": STAGES, "nx": [STATES] * (STAGES + 1), "nu": [CONTROLS] * STAGES + [0], "ng": stages.counts,
        "hpipm": {"mode": "speed_abs", "iter_max": 100},
    }  # fmt: skip
    start = np.full(len(form.q), np.inf)
    start[:STATES] = 0.0
    # The first state has bounds in place of rows.
    first = np.concatenate([program.initial, np.zeros(len(form.q) - STATES)])
    sides = {"lba": stages.lower, "uba": stages.upper, "lbx": first - start, "ubx": first + start}
    v, stats = _conic("hpipm", options, _entries(form.P), form.q, _entries(stages.rows), sides)
    return answer(stats["t_wall_solver"], stats["success"], False, Full.controls(v))


def _conic(plugin: str, options: dict[str, Any], h: Any, g: Array, a: Any, sides: dict[str, Array]) -> tuple[Array, Any]:
    """Solves a program by a plugin of CasADi: solution and statistics."""
    import casadi

    shape = {"h": h.sparsity(), "a": a.sparsity()}
    # A failure is an answer, and only with `record_time` does CasADi time the solver.
    usual = {"error_on_fail": False, "record_time": True}
    with _silence():
        # A solver that has solved before would start from there.
        solver = casadi.conic("solver", plugin, shape, {**usual, **options})
        result = solver(h=h, g=g, a=a, **sides)
    return np.array(result["x"]).ravel(), solver.stats()


@contextmanager
def _silence() -> Iterator[None]:
    """Drops what C code prints: qpOASES prints its licence each time."""
    kept, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nothing, 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nothing)


def _entries(matrix: Any) -> Any:
    """A matrix for CasADi."""
    import casadi

    if isinstance(matrix, np.ndarray):
        return casadi.DM(matrix)
    matrix.sort_indices()
    places = casadi.Sparsity(*matrix.shape, matrix.indptr.tolist(), matrix.indices.tolist())
    return casadi.DM(places, matrix.data)


TIGHT = {"abstol": 1e-8, "reltol": 1e-9, "feastol": 1e-8}

PEERS = [
    Peer("clarabel", "clarabel", "full sparse", "python", "solve", 3, clarabel),
    Peer("cvxopt", "cvxopt", "full sparse", "python", "set-up, solve", 3, partial(cvxopt, {})),
    Peer(
        "cvxopt-tight", "cvxopt", "full sparse", "python", "set-up, solve", 3,
        partial(cvxopt, TIGHT),
    ),
    Peer("daqp", "daqp", "two-sided dense", "native", "set-up, solve", 50, daqp),
    Peer("daqp-model", "daqp", "two-sided dense", "native", "solve", 50, DaqpModel(False)),
    Peer(
        "daqp-model-update", "daqp", "two-sided dense", "python", "update, solve", 50,
        DaqpModel(True),
    ),
    Peer("daqp-native", "daqp", "two-sided dense", "native", "update, solve", 50, DAQP_NATIVE),
    Peer("hpipm", "casadi", "full by stage", "native", "solve", 10, hpipm),
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
    Peer("qpoases", "casadi", "condensed dense", "native", "set-up, solve", 10, qpoases),
]
