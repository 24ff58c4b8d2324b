"""Fits 75 quadratic elements to the helix of Harsch & Eugster, section 4.1, by eq. (21), with SciPy.

Independent of any rod solver, and as the paper writes it: 7 unknowns a node with quaternions of any norm, the
interpolated matrix not projected, the angle of the logarithm from its trace. Rotations are not stored: the norm of a
quaternion is not determined, and the positions hardly see them.

Accuracy: 1e-13 m. The Jacobian is exact (complex steps), the last step of Gauss and Newton moves no node by 1e-14 m, and
a second minimisation from displaced nodes ends within 1e-13 m; the script fails otherwise.
"""

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from datapackage import Field, Table, fields, root

COILS, RADIUS, PITCH, ELEMENTS, SAMPLES = 10, 10e-3, 5e-3, 75, 301
NODES = 2 * ELEMENTS + 1


def helix(xi):
    """Positions and Serret-Frenet frames, eqs. (19) and below."""
    phi, c = 2 * np.pi * COILS * xi, PITCH / (2 * np.pi * RADIUS)
    s, k, o = np.sin(phi), np.cos(phi), np.zeros_like(phi)
    frames = [np.stack(v, -1) for v in ((k, s, o + c), (-s, k, o), (-c * k, -c * s, o + 1))]
    scale = np.hypot(1, c)
    return RADIUS * np.stack([s, -k, c * phi], -1), np.stack([frames[0] / scale, frames[1], frames[2] / scale], -1)


def skew(a):
    o = np.zeros_like(a[:, 0])
    x, y, z = a.T
    return np.stack([np.stack(row, -1) for row in ((o, -z, y), (z, o, -x), (-y, x, o))], 1)


def matrix(p):
    """A(P), eq. (5)."""
    t = skew(p[:, 1:])
    return np.eye(3) + 2 * (t @ t + p[:, :1, None] * t) / (p * p).sum(1)[:, None, None]


def logarithm(a, r):
    """(V^-1 r, psi) with the angle from the trace."""
    cosine = 0.5 * (np.einsum("nii->n", a) - 1)
    angle = np.arccos(np.where(cosine.real < 1, cosine, 1))
    factor = np.where(angle.real > 1e-6, angle / np.sin(np.where(angle.real > 1e-6, angle, 1)), 1)
    psi = 0.5 * factor[:, None] * np.stack(
        [a[:, 2, 1] - a[:, 1, 2], a[:, 0, 2] - a[:, 2, 0], a[:, 1, 0] - a[:, 0, 1]], -1
    )
    square = (psi * psi).sum(1)
    small = abs(square) < 1e-8
    half = 0.5 * np.sqrt(np.where(small, 1, square))
    d = np.where(small, 1 / 12, (1 - half / np.tan(half)) / np.where(small, 1, square))
    t = skew(psi)
    inverse = np.eye(3) - 0.5 * t + d[:, None, None] * (t @ t)
    return np.concatenate([np.einsum("nij,nj->ni", inverse, r), psi], -1)


XI = np.arange(SAMPLES) / (SAMPLES - 1)
ELEMENT = np.minimum((XI * ELEMENTS + 1e-12).astype(int), ELEMENTS - 1)
X = XI * ELEMENTS - ELEMENT
SHAPES = np.stack([(1 - X) * (1 - 2 * X), 4 * X * (1 - X), X * (2 * X - 1)], -1)
CONNECTIVITY = 2 * ELEMENT[:, None] + np.arange(3)
TARGET_R, TARGET_A = helix(XI)


def residual(q):
    q = q.reshape(NODES, 7)
    r = np.einsum("ni,nij->nj", SHAPES, q[CONNECTIVITY, :3])
    a = np.einsum("ni,nijk->njk", SHAPES, matrix(q[:, 3:])[CONNECTIVITY])
    back = TARGET_A.transpose(0, 2, 1)
    return logarithm(back @ a, np.einsum("nij,nj->ni", back, r - TARGET_R)).ravel()


def jacobian(q):
    """Complex steps; nodes four apart share no sample."""
    result, nodes = np.zeros((6 * SAMPLES, 7 * NODES)), np.arange(NODES)
    for colour in range(4):
        for k in range(7):
            step = q.astype(complex).reshape(NODES, 7)
            step[nodes % 4 == colour, k] += 1e-30j
            change = (residual(step.ravel()).imag / 1e-30).reshape(SAMPLES, 6)
            for i in range(3):
                for j in np.flatnonzero(CONNECTIVITY[:, i] % 4 == colour):
                    result[6 * j : 6 * j + 6, 7 * CONNECTIVITY[j, i] + k] = change[j]
    return result


def minimise(start):
    """Positions at the minimum: SciPy's, and then steps of Gauss and Newton without a test that stops them early."""
    q = least_squares(residual, start, jac=jacobian, ftol=1e-15, xtol=1e-15, gtol=1e-15).x
    for _ in range(4):
        slopes = jacobian(q)
        step = np.linalg.lstsq(slopes, residual(q), rcond=1e-10)[0]
        print(f"gradient {np.abs(slopes.T @ residual(q)).max():.1e}, step {np.abs(step).max():.1e}", flush=True)
        q = q - step
    assert np.abs(step.reshape(NODES, 7)[:, :3]).max() < 1e-14
    return q.reshape(NODES, 7)[:, :3]


def main():
    r, a = helix(np.arange(NODES) / (NODES - 1))
    quaternions = Rotation.from_matrix(a).as_quat()[:, [3, 0, 1, 2]]
    start = np.concatenate([r, quaternions], -1)
    nodes = minimise(start.ravel())
    start[:, :3] += 1e-5 * np.random.default_rng(1).standard_normal((NODES, 3))
    apart = np.abs(minimise(start.ravel()) - nodes).max()
    print("from displaced nodes:", apart)
    assert apart < 1e-13
    Table(
        source="scipy",
        name="spring_fit",
        title="The spring's helix fitted by 75 quadratic elements, eq. (21): positions of the nodes",
        fields=[
            Field("node", "1", "number from the start of the wire on"),
            *fields("x y z", "m", "position, {}", tolerance=3e-14),
        ],
        rows=[[node, *position] for node, position in enumerate(nodes.tolist())],
        accuracy="1e-13 m",
        accuracy_method="last step below 1e-14 m with an exact Jacobian; a second minimisation from displaced nodes",
        parameters={"elements": ELEMENTS, "degree": 2, "samples": SAMPLES, "tolerances": 1e-15, "seed": 1},
        tools=["numpy", "scipy"],
    ).write(root())


if __name__ == "__main__":
    main()
