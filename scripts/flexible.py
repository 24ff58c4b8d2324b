"""A free-flying flexible rod with an exact solution of large motion: a closed ring that is spun up, stretches and breathes.

A ring of reference radius R (arc of 2 pi, its ends joined rigidly), free in space, initially at rest and unstressed, carries
line forces per reference length in the *section's* basis: f_1 along the tangent e_x, f_2 along e_y (to the centre), both constant.
By symmetry every section does the same: radius rho(t), turn of the centreline point a(t), turn of the section b(t), and
    strain (rho/R cos d, -rho/R sin d, 0) with d = b - a,  curvature unchanged (1/R; bending and torsion stay unstressed),
so the rod equations become three ordinary ones. Per reference length,
    T = rA/2 (rho'^2 + rho^2 a'^2) + rI_z/2 b'^2,   V = EA/2 (rho/R cos d - 1)^2 + GA_y/2 (rho/R sin d)^2.
With gravity the centre falls freely on top of this. The section's basis turns by b about e_z.

Accuracy: Lagrange's equations of (rho, a, b) with DOP853, against the balances of one section in Cartesian coordinates
(n' = e_z x n / R, r' = e_z x r / R, m' = 0) with implicit Gauss (Radau's stiff code would do as well); energy balance printed.

Right-angle cantilever: see straight_rod_frequencies.py for its frequencies; prints the geometry only.
Needs numpy and scipy; some seconds.
"""

import numpy as np
from scipy.integrate import solve_ivp

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
    times = np.array([0.25, 0.5, 1.0, 1.5, 2.0])
    a = solve_ivp(lagrange, (0, 2), [R, 0, 0, 0, 0, 0, 0], "DOP853", times, rtol=3e-14, atol=1e-15).y.T
    b = solve_ivp(cartesian, (0, 2), [0, -R, 0, 0, 0, 0], "DOP853", times, rtol=3e-14, atol=1e-15).y.T
    c = solve_ivp(cartesian, (0, 2), [0, -R, 0, 0, 0, 0], "Radau", times, rtol=1e-11, atol=1e-13).y.T
    print(f"ring R {R}, EA {EA}, GA_y {GA}, rho A {RHO_A}, rho I_z {RHO_I}; f = ({F1}, {F2}, 0) in the section's basis")
    print("t, radius, turn of the centreline, turn of the section, kinetic, strain energy (whole ring, without gravity); x, y at xi = 0")
    for t, s, q in zip(times, a, b):
        p, turn, section, dp, da, db, work = s
        kinetic = RHO_A / 2 * (dp ** 2 + p ** 2 * da ** 2) + RHO_I / 2 * db ** 2
        strain = EA / 2 * (p / R * np.cos(section - turn) - 1) ** 2 + GA / 2 * (p / R * np.sin(section - turn)) ** 2
        print(t, [float(f"{v:.14g}") for v in (p, turn, section, 2 * np.pi * R * kinetic, 2 * np.pi * R * strain)],
              [float(f"{v:.14g}") for v in q[:2]], f"energy - work {kinetic + strain - work:.1e}")
    polar = np.column_stack([a[:, 0] * np.sin(a[:, 1]), -a[:, 0] * np.cos(a[:, 1]), a[:, 2]])
    print("Lagrange against Cartesian", np.abs(polar - b[:, :3]).max(), "DOP853 against Radau (1e-11)", np.abs(b - c)[:, :3].max())
    print("initial acceleration of the radius", -F2 / RHO_A, "of the turn", F1 / (RHO_A * R))


if __name__ == "__main__":
    main()
