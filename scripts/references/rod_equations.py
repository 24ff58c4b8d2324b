"""The continuous equations of a static Cosserat rod, and how they are solved: no finite elements. Shared by generators.

With the reference arc length s, inertial resultants n and m, A = A(P) the rotation of the section's basis,

    r' = A (e_x + K_gamma^-1 A^T n),               P' = 1/2 P (0, kappa),  kappa = kappa0 + K_kappa^-1 A^T m,
    n' = -(f + A f_B),                             m' = -r' x n - (l + A l_B),

f and l line loads per reference length with components in the inertial basis (dead), f_B and l_B in the section's
basis (they turn with it). Clamped at s = 0, so r and P are known there; at s = L, with a lever rho in the section,

    n = F + A F_B,   m = M + A M_B + A rho x (F + A F_B).

The clamp acts on the rod with the force -n(0) and the moment -m(0) (Antman, Nonlinear Problems of Elasticity, ch. VIII).

Solved by Gauss collocation on equal intervals (order 2 x stages; Ascher, Mattheij & Russell, ch. 5), all intervals at
once by Newton's method with derivatives by complex steps. The load is brought up in steps that must converge at once
and near the extrapolated guess, since slender rods have other equilibria. Then everything is solved again in two ways:
with more stages, and by multiple shooting, where SciPy's Runge-Kutta code DOP853 integrates each interval. What the
tables say about their accuracy is asserted for the differences of the three.

All is computed in units of the rod's length L and of its larger bending stiffness B: forces in B/L^2, moments in B/L.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

# Of the path, and of the two solutions at its reported points.
PATH_STAGES, STAGES, MORE_STAGES = 3, 6, 8
# Asserted for the differences of the three solutions, and stated of the tables: positions over L, rotations [rad], forces
# over the largest of the rod and B/L^2, moments likewise and B/L.
ACCURACY = {"position": 1e-12, "rotation": 1e-11, "force": 1e-11, "moment": 1e-11}
NEWTON = 1e-14
# How far a load step may end from its guess, positions over L and quaternions.
NEAR = 0.2
ZERO = (0.0, 0.0, 0.0)


def multiply(p, q):
    """Product of quaternions, scalar first."""
    scalar = p[..., :1] * q[..., :1] - (p[..., 1:] * q[..., 1:]).sum(-1, keepdims=True)
    return np.concatenate([scalar, p[..., :1] * q[..., 1:] + q[..., :1] * p[..., 1:] + cross(p[..., 1:], q[..., 1:])], -1)


def cross(a, b):
    product = np.empty(np.broadcast_shapes(a.shape, b.shape), np.result_type(a, b))
    for k, i, j in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        product[..., k] = a[..., i] * b[..., j] - a[..., j] * b[..., i]
    return product


def turn(p, v):
    """A(P) v for a quaternion of any norm; the inverse for the conjugate."""
    vector = p[..., 1:]
    t = cross(vector, v)
    return v + (2 / (p * p).sum(-1, keepdims=True)) * (p[..., :1] * t + cross(vector, t))


def conjugate(p):
    return p * np.array([1.0, -1, -1, -1])


@dataclass
class Rod:
    """A uniform rod clamped at s = 0; SI units. Infinite stiffness rules a strain out."""

    length: float
    force_stiffness: tuple
    moment_stiffness: tuple
    curvature: tuple = ZERO
    position: tuple = ZERO
    quaternion: tuple = (1.0, 0.0, 0.0, 0.0)
    # Intervals of the collocation, a multiple of the number of stations that are reported.
    intervals: int = 40
    # Loads: at the tip, along the rod; the lever of the tip force.
    force: tuple = ZERO
    body_force: tuple = ZERO
    moment: tuple = ZERO
    body_moment: tuple = ZERO
    line_force: tuple = ZERO
    body_line_force: tuple = ZERO
    line_moment: tuple = ZERO
    body_line_moment: tuple = ZERO
    lever: tuple = ZERO
    units: dict = field(init=False)

    def __post_init__(self):
        length, bending = self.length, max(self.moment_stiffness[1:])
        force, moment = bending / length**2, bending / length
        powers = {"force": force, "moment": moment, "line_force": force / length, "line_moment": moment / length}
        loads = powers | {f"body_{name}": unit for name, unit in powers.items()}
        self.units = {name: np.array(getattr(self, name)) / unit for name, unit in loads.items()}
        self.units |= {
            "stretch": force / np.array(self.force_stiffness),
            "bend": bending / np.array(self.moment_stiffness),
            "curvature": np.array(self.curvature) * length,
            "lever": np.array(self.lever) / length,
            "clamp": np.array([*np.array(self.position) / length, *self.quaternion]),
        }

    def slope(self, y, factor):
        """y' of y = (r, P, n, m)."""
        u = self.units
        p, n, m = y[..., 3:7], y[..., 7:10], y[..., 10:]
        stretch = turn(conjugate(p), n) * u["stretch"] + np.array([1.0, 0, 0])
        bend = turn(conjugate(p), m) * u["bend"] + u["curvature"]
        dr = turn(p, stretch)
        dp = 0.5 * multiply(p, np.concatenate([0 * bend[..., :1], bend], -1))
        dn = -factor * (u["line_force"] + turn(p, u["body_line_force"] + 0 * n))
        dm = -cross(dr, n) - factor * (u["line_moment"] + turn(p, u["body_line_moment"] + 0 * n))
        return np.concatenate([dr, dp, dn, dm], -1)

    def tip(self, y, factor):
        """What must vanish at s = L."""
        u, p = self.units, y[3:7]
        n = factor * (u["force"] + turn(p, u["body_force"] + 0 * p[1:]))
        m = factor * (u["moment"] + turn(p, u["body_moment"] + 0 * p[1:])) + cross(turn(p, u["lever"] + 0 * p[1:]), n)
        return np.concatenate([y[7:10] - n, y[10:] - m])

    def unloaded(self, s):
        """y of the reference: the frame turns about kappa0, which stays where it is in it."""
        kappa, clamp = self.units["curvature"], self.units["clamp"]
        size = np.linalg.norm(kappa)
        axis = kappa / size if size > 0 else np.array([1.0, 0, 0])
        angle = np.asarray(s)[:, None] * size
        local = np.concatenate([np.cos(angle / 2), np.sin(angle / 2) * axis], -1)
        # Integral of the tangent, by Rodrigues' formula.
        along, x = np.asarray(s)[:, None], np.array([1.0, 0, 0])
        wave = (1 - np.cos(angle)) / size if size > 0 else 0 * angle
        rest = along - np.sin(angle) / size if size > 0 else 0 * angle
        r = along * x + wave * cross(axis, x) + rest * cross(axis, cross(axis, x))
        p0 = np.broadcast_to(clamp[3:], local.shape)
        return np.concatenate([clamp[:3] + turn(p0, r), multiply(p0, local), np.zeros((len(r), 6))], -1)


def derivative(function, y):
    """The Jacobian at many points, by complex steps."""
    columns = [function(y + 1e-30j * np.eye(y.shape[-1])[k]).imag / 1e-30 for k in range(y.shape[-1])]
    return np.stack(columns, -1)


class Gauss:
    """Points, weights and integration matrix of Gauss collocation on [0, 1]."""

    def __init__(self, stages):
        x, w = np.polynomial.legendre.leggauss(stages)
        self.points, self.weights = (1 + x) / 2, w / 2
        # Legendre's polynomials, and their integrals from 0: f(t) = sum (2k + 1) P_k sum_j w_j P_k(x_j) f(x_j).
        p = np.polynomial.legendre.legvander(x, stages).T
        integrals = 0.5 * np.array([1 + x, *(p[2:] - p[:-2])])
        self.matrix = integrals.T @ p[:-1] * self.weights


def interpolation(old, new):
    """Values at 0, old points and 1 to values at new points."""
    points = np.array([0.0, *old, 1.0])
    powers = np.arange(len(points))
    return (new[:, None] ** powers) @ np.linalg.inv(points[:, None] ** powers)


def correct(rod, factor, nodes, transfer, gap):
    """Newton's correction of the values at the ends of the intervals: d_(k+1) = transfer d_k + gap, and the ends."""
    count = len(nodes) - 1
    inner = np.arange(13 * count)
    rows, columns, values = [np.arange(7), 7 + inner], [np.arange(7), 13 + inner], [np.ones(7), np.ones(13 * count)]
    end = derivative(lambda y: rod.tip(y, factor), nodes[-1])
    for row, column, block in ((7, 0, -transfer), (7 + 13 * count, 13 * count, end[None])):
        height, width = block.shape[1:]
        k, i, j = np.indices(block.shape).reshape(3, -1)
        rows.append(row + height * k + i)
        columns.append(column + width * k + j)
        values.append(block.ravel())
    places = (np.concatenate(rows), np.concatenate(columns))
    matrix = coo_matrix((np.concatenate(values), places), (13 * (count + 1), 13 * (count + 1)))
    right = np.concatenate([rod.units["clamp"] - nodes[0, :7], gap.ravel(), -rod.tip(nodes[-1], factor)])
    return splu(matrix.tocsc()).solve(right).reshape(nodes.shape)


@dataclass
class State:
    """Values at the ends of the intervals, at the stages, and how a change at one end arrives at the other."""

    nodes: np.ndarray
    stages: np.ndarray
    transfer: np.ndarray | None = None

    def extrapolated(self, other, ratio):
        move = lambda a, b: a + ratio * (a - b)
        return State(move(self.nodes, other.nodes), move(self.stages, other.stages))

    def distance(self, other):
        """Of positions and quaternions."""
        return np.abs(self.nodes - other.nodes)[:, :7].max()


def size(nodes):
    """Of each kind of quantity, at least 1."""
    largest = lambda part: max(1.0, np.abs(nodes[:, part]).max())
    kinds = [(slice(0, 3), 3), (slice(3, 7), 4), (slice(7, 10), 3), (slice(10, 13), 3)]
    return np.concatenate([np.full(count, largest(part)) for part, count in kinds])


def collocate(rod, factor, guess, rule, iterations):
    """Newton on the collocation equations; None if it does not converge in so many iterations."""
    nodes, stages = guess.nodes.copy(), guess.stages.copy()
    count, order = len(nodes) - 1, len(rule.points)
    h = 1.0 / count
    best = np.inf
    for _ in range(iterations):
        slopes = rod.slope(stages, factor)
        jacobian = derivative(lambda y: rod.slope(y, factor), stages)
        miss = nodes[:-1, None] + h * np.einsum("ij,kja->kia", rule.matrix, slopes) - stages
        blocks = -h * np.einsum("ij,kjab->kiajb", rule.matrix, jacobian)
        blocks[:, np.arange(order), :, np.arange(order), :] += np.eye(13)
        right = np.concatenate([np.broadcast_to(np.tile(np.eye(13), (order, 1)), (count, 13 * order, 13)),
                                miss.reshape(count, -1, 1)], -1)
        inner = np.linalg.solve(blocks.reshape(count, 13 * order, -1), right).reshape(count, order, 13, 14)
        weighted = h * np.einsum("j,kjab->kjab", rule.weights, jacobian)
        moved = np.einsum("kjab,kjbc->kac", weighted, inner)
        transfer = np.eye(13) + moved[..., :13]
        gap = nodes[:-1] + h * np.einsum("j,kja->ka", rule.weights, slopes) - nodes[1:] + moved[..., 13]
        change = correct(rod, factor, nodes, transfer, gap)
        if not np.isfinite(change).all():
            return None
        stages = stages + np.einsum("kjab,kb->kja", inner[..., :13], change[:-1]) + inner[..., 13]
        nodes = nodes + change
        step = np.abs(change / size(nodes)).max()
        # Quadratic convergence ends at rounding, which it reaches when a step is no longer shorter than the last.
        if step < NEWTON or (step < 1e-10 and step > 0.1 * best):
            return State(nodes, stages, transfer)
        best = min(best, step)
    return None


def shoot(rod, factor, state):
    """The same by DOP853 on each interval; the collocation lends its transfer matrices as approximate derivatives."""
    nodes, count = state.nodes.copy(), len(state.nodes) - 1
    scale = size(nodes)

    def slope(_, y):
        return (rod.slope(y.reshape(count, 13) * scale, factor) / scale / count).ravel()

    best = np.inf
    for _ in range(8):
        start = (nodes[:-1] / scale).ravel()
        ends = solve_ivp(slope, (0, 1), start, "DOP853", (1.0,), rtol=3e-14, atol=1e-15).y[:, -1]
        change = correct(rod, factor, nodes, state.transfer, ends.reshape(count, 13) * scale - nodes[1:])
        nodes = nodes + change
        step = np.abs(change / scale).max()
        if step > 0.3 * best:
            return nodes
        best = step
    return nodes


@dataclass
class Solution:
    """Values at the ends of the intervals in SI units, and the largest differences of the three solutions."""

    factor: float
    position: np.ndarray
    quaternion: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    accuracy: dict
    differences: dict

    @property
    def clamp(self):
        """Force and moment of the clamp on the rod."""
        return [*-self.force[0], *-self.moment[0]]

    def pose(self, k=-1):
        return [*self.position[k], *self.quaternion[k]]


def resolve(rod, factor, state, old, new):
    """The solution with other stages."""
    values = np.concatenate([state.nodes[:-1, None], state.stages, state.nodes[1:, None]], 1)
    stages = np.einsum("ij,kja->kia", interpolation(old.points, new.points), values)
    return collocate(rod, factor, State(state.nodes, stages), new, 20)


def finish(rod, factor, state):
    """The solution by most stages, compared with the other two; fails if they are further apart than is stated."""
    path, few, many = Gauss(PATH_STAGES), Gauss(STAGES), Gauss(MORE_STAGES)
    coarse = resolve(rod, factor, state, path, few)
    fine = resolve(rod, factor, coarse, few, many)
    nodes, scale = fine.nodes, size(fine.nodes)
    differences = dict.fromkeys(ACCURACY, 0.0)
    for other in (coarse.nodes, shoot(rod, factor, fine)):
        apart = np.abs(other - nodes) / scale
        for name, part in (("position", slice(0, 3)), ("force", slice(7, 10)), ("moment", slice(10, 13))):
            differences[name] = max(differences[name], apart[:, part].max())
        differences["rotation"] = max(differences["rotation"], 2 * apart[:, 3:7].max())
    for name, bound in ACCURACY.items():
        if not differences[name] < bound:
            raise ArithmeticError(f"{name}s apart by {differences[name]:.1e} at load factor {factor}: {rod}")
    length, bending = rod.length, max(rod.moment_stiffness[1:])
    units = {"position": length, "rotation": 1.0, "force": bending / length**2, "moment": bending / length}
    largest = {"position": 1.0, "rotation": 1.0, "force": scale[7], "moment": scale[10]}
    accuracy = {name: bound * units[name] * largest[name] for name, bound in ACCURACY.items()}
    quaternions = nodes[:, 3:7] / np.linalg.norm(nodes[:, 3:7], axis=1)[:, None]
    return Solution(factor, nodes[:, :3] * length, quaternions, nodes[:, 7:10] * units["force"],
                    nodes[:, 10:] * units["moment"], accuracy, differences)


def follow(rod, factors=(1.0,)):
    """The solutions at load factors, along the path from no load."""
    rule, count = Gauss(PATH_STAGES), rod.intervals
    ends = np.arange(count + 1) / count
    inside = (np.arange(count)[:, None] + rule.points) / count
    now = State(rod.unloaded(ends), rod.unloaded(inside.ravel()).reshape(count, -1, 13))
    at, step, before, solutions = 0.0, 0.01 * max(factors), None, []
    for target in factors:
        while at < target:
            factor = min(at + step, target)
            guess = now.extrapolated(before[1], (factor - at) / (at - before[0])) if before else now
            found = collocate(rod, factor, guess, rule, 9)
            if found is not None and found.distance(guess) < NEAR:
                before, now, at = (at, now), found, factor
                step *= 1.5
            else:
                step = 0.5 * (factor - at)
                if step < 1e-9 * max(factors):
                    raise ArithmeticError(f"no solution beyond load factor {at}: {rod}")
        solutions.append(finish(rod, target, now))
    return solutions
