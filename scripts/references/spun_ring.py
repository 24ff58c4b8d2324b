"""A free-flying flexible rod with an exact solution of large motion: a closed ring that is spun up, stretches and breathes.

A ring of reference radius R (arc of 2 pi, its ends joined rigidly), free in space, initially at rest and unstressed, carries
line forces per reference length in the *section's* basis: f_1 along the tangent e_x, f_2 along e_y (to the centre), both constant.
By symmetry every section does the same: radius rho(t), turn of the centreline point a(t), turn of the section b(t), and
    strain (rho/R cos d, -rho/R sin d, 0) with d = b - a,  curvature unchanged (1/R; bending and torsion stay unstressed),
so the rod equations become three ordinary ones. Per reference length,
    T = rA/2 (rho'^2 + rho^2 a'^2) + rI_z/2 b'^2,   V = EA/2 (rho/R cos d - 1)^2 + GA_y/2 (rho/R sin d)^2.
With gravity the centre falls freely on top of this. The section's basis turns by b about e_z.

Accuracy: 1e-11, relative. Lagrange's equations of (rho, a, b) with DOP853, against the balances of one section in Cartesian
coordinates (n' = e_z x n / R, r' = e_z x r / R, m' = 0) with DOP853 and with Radau's implicit method (to its tolerance);
the energy is the work of the loads. The script fails if they differ by more.
"""

import numpy as np
from scipy.integrate import solve_ivp

from datapackage import Field, Table, fields, root

R, EA, GA, RHO_A, RHO_I = 1.0, 100.0, 60.0, 1.0, 0.05  # rho I about e_z
F1, F2 = 4.0, -6.0


def lagrange(t, y):
    """rho, a, b and rates; last: work of the loads per reference length."""
    p, _, _, dp, da, db, _ = y
    d = y[2] - y[1]
    c, s = np.cos(d), np.sin(d)
    axial, shear = EA * (p / R * c - 1), GA * p / R * s
    # load in polar directions: e_1 is turned by d from the tangent, e_2 from the inward normal
    radial, tangential = -F1 * s - F2 * c, F1 * c - F2 * s
    v_p = axial * c / R + shear * s / R
    v_d = -axial * p / R * s + shear * p / R * c
    ddp = p * da ** 2 + (radial - v_p) / RHO_A
    dda = (tangential * p + v_d - 2 * RHO_A * p * dp * da) / (RHO_A * p ** 2)
    return np.array([dp, da, db, ddp, dda, -v_d / RHO_I, radial * dp + tangential * p * da])


def cartesian(t, y):
    """x, y, angle of the section that starts at (0, -R) with its e_x along +x, and rates."""
    r, b, v, w = y[:2], y[2], y[3:5], y[5]
    e1, e2 = np.array([np.cos(b), np.sin(b)]), np.array([-np.sin(b), np.cos(b)])
    turn = lambda a: np.array([-a[1], a[0]])
    slope = turn(r) / R
    n = EA * (slope @ e1 - 1) * e1 + GA * (slope @ e2) * e2
    acceleration = (turn(n) / R + F1 * e1 + F2 * e2) / RHO_A
    return np.array([*v, w, *acceleration, (slope[0] * n[1] - slope[1] * n[0]) / RHO_I])


def main():
    times = np.arange(81) / 40
    a = solve_ivp(lagrange, (0, 2), [R, 0, 0, 0, 0, 0, 0], "DOP853", times, rtol=3e-14, atol=1e-15).y.T
    b = solve_ivp(cartesian, (0, 2), [0, -R, 0, 0, 0, 0], "DOP853", times, rtol=3e-14, atol=1e-15).y.T
    c = solve_ivp(cartesian, (0, 2), [0, -R, 0, 0, 0, 0], "Radau", times, rtol=1e-11, atol=1e-13).y.T
    p, turn, section, dp, da, db, work = a.T
    kinetic = RHO_A / 2 * (dp**2 + p**2 * da**2) + RHO_I / 2 * db**2
    strain = EA / 2 * (p / R * np.cos(section - turn) - 1) ** 2 + GA / 2 * (p / R * np.sin(section - turn)) ** 2
    polar = np.column_stack([p * np.sin(turn), -p * np.cos(turn), section])
    errors = np.abs(polar - b[:, :3]).max(), np.abs(kinetic + strain - work).max(), np.abs(b - c)[:, :3].max()
    print("Lagrange against Cartesian, energy against work, DOP853 against Radau (1e-11)", errors)
    assert max(errors[:2]) < 1e-11 and errors[2] < 1e-8
    around = 2 * np.pi * R
    columns = [
        Field("t", "s", "time"),
        Field("radius", "m", "radius of the ring", tolerance=3e-12),
        Field("turn", "rad", "turn of a point of the centreline about the centre", tolerance=3e-12),
        Field("section", "rad", "turn of the section about e_z", tolerance=3e-12),
        *fields("kinetic strain", "J", "{} energy of the whole ring", relative_tolerance=3e-12, tolerance=1e-12),
        *fields("x y", "m", "point that starts at (0, -R), centre at rest, {}", tolerance=3e-12),
    ]
    Table(
        source="continuous", name="spun_ring", title="Closed ring spun up and blown up by a load that turns with it",
        fields=columns,
        rows=np.column_stack([times, p, turn, section, around * kinetic, around * strain, b[:, :2]]).tolist(),
        accuracy="1e-11, relative",
        accuracy_method="two formulations with DOP853, one of them with Radau's method as well; energy against work",
        parameters={"R": R, "EA": EA, "GA": GA, "rhoA": RHO_A, "rhoI": RHO_I, "f1": F1, "f2": F2, "tolerance": 3e-14},
        tools=["numpy", "scipy"],
    ).write(root())


if __name__ == "__main__":
    main()
