"""Motion of the Wilberforce pendulum with a *massless* wire (`inertia = false`), from the continuous rod equations.

The bob is a rigid body (position, unit quaternion, velocity, body angular velocity); at every instant the wire is in
static equilibrium, so its force and moment on the bob follow from a boundary-value problem: integrate
    r' = A (G0 + C_g^-1 A^T n),  A' = A [k0 + C_k^-1 A^T m]x,  n constant,  m = M + (x_S - r) x n
from the bob's end to the clamp and find (n, M) that meet the clamp (multiple shooting, Newton). Released at rest from
the unstressed helix; weight of the bob only; no damping. Data as in wilberforce.py.

Accuracy: position 1e-9 m, quaternion 2e-8, alpha 5e-8 rad, judged by a second run with fewer pieces of wire (DOP853's
eighth-order formula on each) and ten times the tolerance in time, at every stored instant, and by the total energy
(kinetic, strain of the wire, weight), which stays zero. The script fails if its runs differ by more than it states.
"""

from math import sqrt

import numpy as np
from scipy.integrate import solve_ivp
from scipy.integrate._ivp import dop853_coefficients as formula
from scipy.spatial.transform import Rotation

from datapackage import Field, Table, fields, root
from wilberforce import CG, CK, K0, LENGTH, MASS, R, S0, SLOPE, STRETCH, THETA, helix

GRAVITY = 9.81
STAGES = 12
A, B = formula.A[:STAGES, :STAGES], formula.B
ROWS = [A[i, :i].copy() for i in range(STAGES)]


def quaternion(frame):
    """Of a rotation matrix with a positive trace or not."""
    x, y, z, w = Rotation.from_matrix(frame).as_quat()
    return np.array([w, x, y, z])


def product(p, q):
    a, b, c, d = p
    e, f, g, h = q
    return np.array([a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e])


def rotate(q, v):
    w, x, y, z = q
    a, b, c = v
    t, u, s = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return np.array([a + w * t + y * s - z * u, b + w * u + z * t - x * s, c + w * s + x * u - y * t])


BOTTOM, TOP = helix(0.0), helix(LENGTH)
Q_BOTTOM, Q_TOP = quaternion(BOTTOM[1]), quaternion(TOP[1])
LEVER = BOTTOM[0] - S0
CG0, CG1, CG2, CK0, CK1, CK2 = *map(float, CG), *map(float, CK)
TORSION, CURVATURE = float(K0[0]), float(K0[2])


class Wire:
    """Multiple shooting: one Runge-Kutta step a piece, all pieces and all differences at once; Newton from the last solution."""

    def __init__(self, steps):
        self.steps, self.h = steps, LENGTH / steps
        self.wrench, self.energy = np.zeros(6), 0.0
        nodes = [helix(self.h * i) for i in range(steps + 1)]
        q = [quaternion(a) for _, a in nodes]
        for i in range(1, steps + 1):
            q[i] = q[i] * np.sign(q[i] @ q[i - 1])
        self.y = np.column_stack([np.array([r for r, _ in nodes]), q])  # (steps + 1, 7)
        self.end_sign = np.sign(Q_TOP @ self.y[-1, 3:])
        # differences: base, 7 of the state, 6 of the wrench
        self.size = np.array([1e-8] * 3 + [1e-7] * 4 + [1e-6] * 3 + [1e-8] * 3)
        self.dy, self.dw = np.zeros((14, 7)), np.zeros((14, 6))
        self.dy[1:8], self.dw[8:] = np.diag(self.size[:7]), np.diag(self.size[7:])

    def rates(self, y, w, x):
        """y (8, columns), w (6, columns)."""
        a, b, c, d = y[3:7]
        n, m = w[:3], w[3:]
        f = 2 / (a * a + b * b + c * c + d * d)
        fb, fc, fd = f * b, f * c, f * d
        ab, ac, ad, bb, bc, bd, cc, cd, dd = a * fb, a * fc, a * fd, b * fb, b * fc, b * fd, c * fc, c * fd, d * fd
        ax, ay, az = 1 - cc - dd, bc + ad, bd - ac
        bx, by, bz = bc - ad, 1 - bb - dd, cd + ab
        cx, cy, cz = bd + ac, cd - ab, 1 - bb - cc
        ux, uy, uz = x[0] - y[0], x[1] - y[1], x[2] - y[2]
        nx, ny, nz = n
        tx, ty, tz = m[0] + uy * nz - uz * ny, m[1] + uz * nx - ux * nz, m[2] + ux * ny - uy * nx
        n1, n2, n3 = ax * nx + ay * ny + az * nz, bx * nx + by * ny + bz * nz, cx * nx + cy * ny + cz * nz
        m1, m2, m3 = ax * tx + ay * ty + az * tz, bx * tx + by * ty + bz * tz, cx * tx + cy * ty + cz * tz
        e1, e2, e3, k1, k2, k3 = n1 / CG0, n2 / CG1, n3 / CG2, m1 / CK0, m2 / CK1, m3 / CK2
        energy = 0.5 * (n1 * e1 + n2 * e2 + n3 * e3 + m1 * k1 + m2 * k2 + m3 * k3)
        e1, k1, k3 = e1 + 1, 0.5 * (k1 + TORSION), 0.5 * (k3 + CURVATURE)
        k2 = 0.5 * k2
        return np.array([ax * e1 + bx * e2 + cx * e3, ay * e1 + by * e2 + cy * e3, az * e1 + bz * e2 + cz * e3,
                         -(b * k1 + c * k2 + d * k3), a * k1 + c * k3 - d * k2, a * k2 + d * k1 - b * k3, a * k3 + b * k2 - c * k1, energy])

    def solve(self, x, q):
        """Force and moment about S of the wire on the bob, and the strain energy."""
        n = self.steps
        start = np.concatenate([x + rotate(q, LEVER), product(q, Q_BOTTOM)])
        start[3:] *= np.sign(start[3:] @ self.y[0, 3:])
        self.y[0] = start
        last = np.inf
        for _ in range(30):
            y = np.zeros((8, 14, n))
            y[:7] = self.y[:-1].T[:, None] + self.dy.T[:, :, None]
            y = y.reshape(8, -1)
            w = np.repeat((self.wrench + self.dw).T[:, :, None], n, axis=2).reshape(6, -1)
            k = np.empty((STAGES, 8, y.shape[1]))
            flat = k.reshape(STAGES, -1)
            for i in range(STAGES):
                k[i] = self.rates(y + self.h * (ROWS[i] @ flat[:i]).reshape(y.shape) if i else y, w, x)
            y = (y + self.h * (B @ flat).reshape(y.shape)).reshape(8, 14, n)
            gap = y[:7, 0].T - self.y[1:]
            slopes = ((y[:7, 1:] - y[:7, :1]) / self.size[:, None]).transpose(2, 0, 1)  # (n, 7, 13)
            chain = np.zeros((n + 1, 7, 7))  # change of the nodes: by the wrench, and the constant part
            for i in range(n):
                nxt = slopes[i, :, :7] @ chain[i]
                nxt[:, :6] += slopes[i, :, 7:]
                nxt[:, 6] += gap[i]
                chain[i + 1] = nxt
            end = self.y[-1]
            turn = np.array([product(Q_TOP * [1, -1, -1, -1], e)[1:] for e in np.eye(4)]).T * self.end_sign / sqrt(end[3:] @ end[3:])
            to = np.zeros((6, 7))
            to[:3, :3], to[3:, 3:] = np.eye(3), 2 * R * turn
            value = np.concatenate([end[:3] - TOP[0], 2 * R * turn @ end[3:]])
            step = -np.linalg.solve(to @ chain[n][:, :6], value + to @ chain[n][:, 6])
            change = chain @ np.append(step, 1)
            self.y += change
            self.wrench = self.wrench + step
            self.energy = y[7, 0].sum()
            size = np.abs(change).max()
            if size < 1e-13 or (size < 1e-10 and size > 0.3 * last):
                return self.wrench, self.energy
            last = size
        raise RuntimeError(f"wire: change {size}")


END, SEGMENT, SAMPLES = 4.0, 0.25, 10
# (Pieces of the wire, tolerance in time): what judges, and what is stored.
COARSE, FINE = (40, 1e-9), (56, 1e-10)
# Accuracy of position, quaternion, alpha; and of the energy [J].
STATED, ENERGY = (1e-9, 2e-8, 5e-8), 1e-9


def motion(pieces, tolerance):
    """Times, states and largest energy, segment by segment, so that the wire's last solution starts the next."""
    wire = Wire(pieces)

    def rates(t, y):
        x, q, v, w = y[:3], y[3:7], y[7:10], y[10:]
        unit = q / sqrt(q @ q)
        wrench, _ = wire.solve(x, unit)
        moment = rotate(unit * [1, -1, -1, -1], wrench[3:])
        a = wrench[:3] / MASS - [0, 0, GRAVITY]
        turn = 0.5 * product(q, np.concatenate([[0], w]))
        return np.concatenate([v, turn, a, (moment - np.cross(w, THETA * w)) / THETA])

    def energy(y):
        q = y[3:7] / sqrt(y[3:7] @ y[3:7])
        _, strain = wire.solve(y[:3], q)
        kinetic = 0.5 * MASS * y[7:10] @ y[7:10] + 0.5 * y[10:] @ (THETA * y[10:])
        return kinetic + MASS * GRAVITY * (y[2] - S0[2]) + strain

    y = np.concatenate([S0, [1, 0, 0, 0], np.zeros(6)])
    scale = np.array([1e-1] * 3 + [1] * 4 + [1] * 3 + [10] * 3)
    times, states, worst = [0.0], [y], 0.0
    for k in range(round(END / SEGMENT)):
        span = k * SEGMENT, (k + 1) * SEGMENT
        s = solve_ivp(rates, span, y, "DOP853", rtol=tolerance, atol=tolerance * scale, first_step=0.01, dense_output=True)
        y = s.y[:, -1]
        inner = span[0] + SEGMENT / SAMPLES * np.arange(1, SAMPLES)
        times += [*inner, span[1]]
        states += [*s.sol(inner).T, y]
        worst = max(worst, abs(energy(y)))
        print(f"{pieces} pieces, {span[1]:.2f} s: {y[:3]}, energy so far {worst:.1e} J", flush=True)
    return np.array(times), np.array(states), worst


def poses(states):
    """Position, unit quaternion and alpha of A = R_x(gamma) R_y(beta) R_z(alpha), atan2(-A12, A11), unwrapped."""
    q = states[:, 3:7] / np.linalg.norm(states[:, 3:7], axis=1)[:, None]
    w, x, y, z = q.T
    return states[:, :3], q, np.unwrap(np.arctan2(2 * (w * z - x * y), 1 - 2 * (y**2 + z**2)))[:, None]


def main():
    times, states, energy = motion(*FINE)
    _, coarse, other_energy = motion(*COARSE)
    found = poses(states)
    apart = [np.abs(a - b).max() for a, b in zip(found, poses(coarse))]
    print("the runs differ by", apart, "energies", energy, other_energy)
    assert all(a <= b for a, b in zip(apart, STATED)) and max(energy, other_energy) < ENERGY
    position, quaternion, alpha = STATED
    Table(
        source="continuous",
        name="wilberforce_motion",
        title="Wilberforce pendulum with a massless wire: motion of the bob",
        fields=[
            Field("t", "s", "time"),
            *fields("x y z", "m", "centre of mass of the bob, inertial, {}", tolerance=0.3 * position),
            *fields("qw qx qy qz", "1", "quaternion from the bob's basis to the inertial one, {}", tolerance=0.3 * quaternion),
            Field("alpha", "rad", "of A = R_x(gamma) R_y(beta) R_z(alpha): atan2(-A12, A11), unwrapped", tolerance=0.3 * alpha),
        ],
        rows=[[round(t, 10), *row] for t, row in zip(times.tolist(), np.hstack(found).tolist())],
        accuracy=f"position {position:.0e} m, quaternion {quaternion:.0e}, alpha {alpha:.0e} rad",
        accuracy_method="two runs with different pieces of the wire and tolerances in time, compared at every instant; "
                        f"total energy constant to {ENERGY:.0e} J",
        parameters={
            "pieces": FINE[0], "tolerance": FINE[1], "judgedByPieces": COARSE[0], "judgedByTolerance": COARSE[1],
        },
        tools=["numpy", "scipy"],
    ).write(root())


if __name__ == "__main__":
    main()
