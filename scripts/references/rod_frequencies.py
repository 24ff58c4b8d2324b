"""Natural frequencies of Cosserat (Timoshenko) rods about their unstressed shape, without finite elements.

  straight_rod_frequencies  straight rod, slender and stocky: bending (rotary inertia, shear factor 1); cantilever,
                            free-free, pinned-pinned.
  tip_body_frequencies      cantilever with a rigid body at its end, its centre of mass off the end.
  frame_frequencies         right-angle frame of two legs (data of Simo & Vu-Quoc 1988), clamped at one end.
  ring_frequencies          closed circular ring: in plane and out of plane.

Bending in one plane: EI p'' + GA (w' - p) = rho I p_tt, GA (w'' - p') = rho A w_tt.
With b^2 = rho A w^2 L^4/EI, r^2 = rho I/(rho A L^2), s^2 = EI/(GA L^2), Huang's (1961) characteristic equations are
  clamped-free: 2 + (b^2 (r^2-s^2)^2 + 2) ch c - b (r^2+s^2)/sqrt(1-b^2r^2s^2) sh s = 0
  free-free:    2 - 2 ch c + b/sqrt(1-b^2r^2s^2) (b^2 r^2 (r^2-s^2)^2 + 3r^2 - s^2) sh s = 0
Pinned-pinned: (EI k^2 + GA - rho I w^2)(GA k^2 - rho A w^2) = GA^2 k^2, k = n pi/L.

Accuracy, relative: straight rods and rings all digits of double precision, tip body 1e-12, frame 1e-10. Straight rods have
30 digits by Huang's equations, and again as the determinant of the transfer matrix exp(B L), and tend to
Euler-Bernoulli's as r and s vanish; tip body and frame come from the 12x12 transfer matrix of the rods, and from Ritz
polynomials of two degrees (upper bounds); the ring from 3x3 Fourier matrices, and as roots of det(transfer matrix over
half a wave + 1) with 100 digits. The script fails if any two differ by more.
"""

import mpmath as mp
import numpy as np
from scipy.linalg import eigh, expm
from scipy.optimize import brentq

from datapackage import Field, Table, root

mp.mp.dps = 30


OMEGA = "angular frequency"


def store(name, title, keys, rows, accuracy, method, tolerance):
    columns = [*keys, Field("omega", "rad/s", OMEGA, relative_tolerance=tolerance)]
    Table(
        source="continuous", name=name, title=title, fields=columns, rows=rows, accuracy=accuracy, accuracy_method=method,
        parameters={"digits": mp.mp.dps}, tools=["mpmath", "numpy", "scipy"],
    ).write(root())


def number(description):
    return Field("mode", "1", description)


def word(name, description):
    return Field(name, "", description, type="string")


# ---------------------------------------------------------------- single rods

def roots(f, first, step, count):
    """Sign changes of f from `first` on, in steps of `step`, refined."""
    out, a, fa = [], mp.mpf(first), f(mp.mpf(first))
    while len(out) < count:
        b = a + step
        fb = f(b)
        if mp.sign(fa) != mp.sign(fb):
            out.append(mp.findroot(f, (a, b), solver="anderson", tol=1e-50, verify=False))
        a, fa = b, fb
    return out


def huang(kind, ei, ga, ra, ri, length):
    def f(w):
        b2 = ra * w * w * length ** 4 / ei
        r2, s2 = ri / (ra * length ** 2), ei / (ga * length ** 2)
        inner = mp.sqrt((r2 - s2) ** 2 + 4 / b2)
        x, y = mp.sqrt(b2 * (-r2 - s2 + inner) / 2 + 0j), mp.sqrt(b2 * (r2 + s2 + inner) / 2)
        root = mp.sqrt(1 - b2 * r2 * s2 + 0j)
        cc, ss = mp.cosh(x) * mp.cos(y), mp.sinh(x) * mp.sin(y)
        b = mp.sqrt(b2)
        if kind == "cantilever":
            value = 2 + (b2 * (r2 - s2) ** 2 + 2) * cc - b * (r2 + s2) / root * ss
        else:
            value = 2 - 2 * cc + b / root * (b2 * r2 * (r2 - s2) ** 2 + 3 * r2 - s2) * ss
        return value.real / mp.cosh(x.real)
    return f


def determinant(kind, ei, ga, ra, ri, length):
    def f(w):
        # state (w, p, q, m): w' = p + q/GA, p' = m/EI, q' = -ra w^2 w, m' = -q - ri w^2 p
        b = mp.matrix([[0, 1, 1 / ga, 0], [0, 0, 0, 1 / ei], [-ra * w * w, 0, 0, 0], [0, -ri * w * w, -1, 0]])
        t = mp.expm(b * length)
        rows, (c, d) = {"cantilever": ((2, 3), (2, 3)), "free": ((2, 3), (0, 1)), "pinned": ((0, 3), (1, 2))}[kind]
        return t[rows[0], c] * t[rows[1], d] - t[rows[0], d] * t[rows[1], c]
    return f


STEEL = mp.mpf("2e11"), mp.mpf("0.3"), mp.mpf(7800)
# Zeros of cosh cos + 1 and of cosh cos - 1: the rod of Euler and Bernoulli.
BETA = {"cantilever": ("1.87510406871196", "4.69409113297418"), "free": ("4.73004074486270", "7.85320462409584")}


def bending(support, *data):
    """The four lowest, and whether the transfer matrix has its roots within 1e-18 of them."""
    ei, ga, ra, ri, length = data
    if support == "pinned":
        found = []
        for n in range(1, 5):
            k = n * mp.pi / length
            a, b, c = ra * ri, -(ra * (ei * k * k + ga) + ri * ga * k * k), ei * ga * k ** 4
            found.append(mp.sqrt((-b - mp.sqrt(b * b - 4 * a * c)) / (2 * a)))
    else:
        euler = mp.sqrt(ei / ra) / length ** 2
        found = roots(huang(support, *data), euler * mp.mpf(BETA[support][0]) ** 2 * mp.mpf("0.4"), euler * mp.mpf("0.9"), 4)
    g, tiny = determinant(support, *data), mp.mpf("1e-18")
    return found, all(mp.sign(g(v * (1 - tiny))) != mp.sign(g(v * (1 + tiny))) for v in found)


def straight():
    young, nu, rho = STEEL
    shear, d, w, h = young / (2 * (1 + nu)), mp.mpf("0.01"), mp.mpf("0.1"), mp.mpf("0.2")
    sections = [("slender", "any", mp.pi * d ** 2 / 4, mp.pi * d ** 4 / 64), ("stocky", "e_y", w * h, w * h ** 3 / 12),
                ("stocky", "e_z", w * h, h * w ** 3 / 12)]
    rows = []
    for rod, axis, area, second in sections:
        for support in ("cantilever", "free", "pinned"):
            found, same = bending(support, young * second, shear * area, rho * area, rho * second, mp.mpf(1))
            print(rod, axis, support, "transfer matrix within 1e-18:", same)
            assert same
            rows += [[rod, support, axis, n + 1, float(v)] for n, v in enumerate(found)]
    for support, beta in BETA.items():  # the limit r = s -> 0
        f = huang(support, mp.mpf(1), mp.mpf(10) ** 16, mp.mpf(1), mp.mpf(10) ** -16, mp.mpf(1))
        found = [mp.sqrt(v) for v in roots(f, 1.5, 1.1, 2)]
        assert all(abs(v - mp.mpf(b)) < 1e-13 for v, b in zip(found, beta))
    store("straight_rod_frequencies", "Bending vibrations of straight steel rods with shear and rotary inertia",
          [word("rod", "slender: circle of diameter 0.01 m; stocky: 0.1 m along e_y, 0.2 m along e_z; both: length 1 m, "
                       "E 2e11 Pa, nu 0.3, rho 7800 kg/m3"),
           word("support", "cantilever, free at both ends, pinned at both ends"), word("axis", "that it bends about"),
           number("without rigid motions, from 1 on")],
          rows, "all digits of double precision",
          "Huang's characteristic equations with 30 digits against transfer matrices; Euler-Bernoulli's limit", 1e-15)


# ---------------------------------------------------------------- rods in space: Ritz and transfer matrices

def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


class Rod:
    """Straight rod: frame (columns e_x along it, e_y, e_z), length, stiffness (EA, GAy, GAz), (GJ, EIy, EIz), rho A, rho I."""

    def __init__(self, frame, length, stretch, bend, mass, inertia):
        self.frame, self.length, self.mass = np.array(frame, float), length, mass
        a = self.frame
        self.cg, self.ck, self.ri = (a @ np.diag(v) @ a.T for v in (stretch, bend, inertia))
        self.tangent = a[:, 0]

    def transfer(self, w):
        """State (u, phi, n, m) from the start to the end."""
        b = np.zeros((12, 12))
        t = skew(self.tangent)
        b[:3, 3:6], b[:3, 6:9] = -t, np.linalg.inv(self.cg)  # u' = phi x t + C^-1 n
        b[3:6, 9:] = np.linalg.inv(self.ck)
        b[6:9, :3], b[9:, 3:6], b[9:, 6:9] = -w * w * self.mass * np.eye(3), -w * w * self.ri, -t
        return expm(b * self.length)


def ritz(rods, degree, body=None):
    """Clamped chain of rigidly connected rods; fields u, phi as polynomials of the rod vanishing at its start, carried on by
    the end values of the rods before. body: (mass, inertia about the centre of mass, offset of it from the last end)."""
    x, weights = np.polynomial.legendre.leggauss(degree + 4)
    x, weights = (x + 1) / 2, weights / 2
    legendre = [np.polynomial.Legendre.basis(k, [0, 1]) for k in range(degree)]
    line = np.polynomial.Legendre([0.5, 0.5], [0, 1])
    shapes = [line * p for p in legendre]
    value = np.array([[p(v) for p in shapes] for v in x])
    slope = np.array([[p.deriv()(v) for p in shapes] for v in x])
    end = np.array([p(1.0) for p in shapes])
    size = 6 * degree * len(rods)
    k, m = np.zeros((size, size)), np.zeros((size, size))
    carried = np.zeros((6, size))
    for number, rod in enumerate(rods):
        own = slice(6 * degree * number, 6 * degree * (number + 1))
        for v, d, wt in zip(value, slope, weights):
            field, rate = carried.copy(), np.zeros((6, size))
            field[:, own], rate[:, own] = np.kron(v, np.eye(6)), np.kron(d, np.eye(6)) / rod.length
            strain = rate[:3] + skew(rod.tangent) @ field[3:]  # u' - phi x t
            k += wt * rod.length * (strain.T @ rod.cg @ strain + rate[3:].T @ rod.ck @ rate[3:])
            m += wt * rod.length * (rod.mass * field[:3].T @ field[:3] + field[3:].T @ rod.ri @ field[3:])
        carried = carried.copy()
        carried[:, own] += np.kron(end, np.eye(6))
    if body:
        mass, inertia, offset = body
        centre = carried[:3] - skew(offset) @ carried[3:]
        m += mass * centre.T @ centre + carried[3:].T @ inertia @ carried[3:]
    scale = 1 / np.sqrt(np.diag(k))
    return 1 / np.sqrt(eigh(m * scale * scale[:, None], k * scale * scale[:, None], eigvals_only=True)[::-1])


def shooting(rods, estimates, body=None):
    def matrix(w):
        t = np.eye(12)
        for rod in rods:
            t = rod.transfer(w) @ t
        free = t[6:, 6:]  # n, m at the end from n, m at the clamp
        if body:
            mass, inertia, offset = body
            u, phi, l = t[:3, 6:], t[3:6, 6:], skew(offset)
            centre = u - l @ phi
            force = w * w * mass * centre  # of the rod on the body it is -w^2 m centre; n is what the + side does to the rod
            free = free - np.vstack([force, w * w * inertia @ phi + l @ force])
        return free

    out = []
    for w in estimates:
        d = np.sqrt((matrix(w * 1.01) ** 2).sum(1))  # one scale for the rows and columns all along
        c = np.sqrt((matrix(w * 1.01) ** 2 / d[:, None] ** 2).sum(0))

        def f(w):
            return np.linalg.det(matrix(w) / d[:, None] / c)
        a, b = w * (1 - 1e-6), w * (1 + 1e-6)
        out.append(brentq(f, a, b, xtol=1e-14, rtol=1e-15) if f(a) * f(b) < 0 else np.nan)
    return np.array(out)


def in_space(title, rods, count, degrees, stated, body=None):
    """By transfer matrices, from where Ritz finds them."""
    a, b = (ritz(rods, degree, body)[:count] for degree in degrees)
    found = shooting(rods, b, body)
    errors = np.abs(a / b - 1).max(), np.abs(found / b - 1).max()
    print(title, "Ritz, degrees", degrees, "differ by", errors[0], "; transfer matrix from Ritz", errors[1])
    assert max(errors) < stated
    return found.tolist()


JUDGED = "transfer matrices against Ritz polynomials of two degrees; closed forms of axial and torsional vibrations"


def tip():
    w, h, young, rho = 0.1, 0.2, 2e11, 7800.0
    shear = young / 2.6
    area, iy, iz = w * h, w * h ** 3 / 12, h * w ** 3 / 12
    rod = Rod(np.eye(3), 1.0, [young * area, shear * area, shear * area], [shear * (iy + iz), young * iy, young * iz], rho * area,
              rho * np.array([iy + iz, iy, iz]))
    rows = []
    for where, offset in (("in line", [0.15, 0, 0]), ("aside", [0.15, 0.1, -0.2])):
        found = in_space(f"tip body {where}:", [rod], 8, (14, 18), 1e-12, (50.0, np.diag([1.0, 2.0, 3.0]), np.array(offset)))
        if where == "in line":
            for wave, ratio in ((np.sqrt(young / rho), rho * area / 50), (np.sqrt(shear / rho), rho * (iy + iz) / 1.0)):
                # k tan k = mass of the rod over that of the body
                first = wave * brentq(lambda k: k * np.tan(k) - ratio, 0.1, 1.57, xtol=1e-15)
                assert min(abs(v / first - 1) for v in found) < 1e-12
        rows += [[where, n + 1, v] for n, v in enumerate(found)]
    store("tip_body_frequencies", "Stocky steel cantilever with a rigid body at its end",
          [word("body", "mass 50 kg, inertia (1, 2, 3) kg m2, centre of mass at (1.15, 0, 0) m (in line) or "
                        "(1.15, 0.1, -0.2) m (aside)"),
           number("from the lowest on")], rows, "1e-12, relative", JUDGED, 3e-13)


def frame():
    data = 10.0, [1e6] * 3, [1e3] * 3, 1.0, [20.0, 10, 10]
    first = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])  # e_x = +y, e_y = -x (default e_z cross tangent)
    found = in_space("frame:", [Rod(first, *data), Rod(np.eye(3), *data)], 10, (16, 20), 1e-10)
    store("frame_frequencies", "Right-angle frame of Simo & Vu-Quoc (1988), clamped at one end: legs of length 10 along y and x",
          [number("from the lowest on")], [[n + 1, v] for n, v in enumerate(found)], "1e-10, relative", JUDGED, 3e-11)


# ---------------------------------------------------------------- ring

def ring():
    rows, radius = [], 1.0
    for name, diameter in (("thin", 0.01), ("thick", 0.2)):
        ea, ga, gj, eiy, eiz, ra, ri = data = circle(diameter)
        for n in range(6):
            q, one = mp.mpf(n) / radius, 1 / mp.mpf(radius)
            plane = fourier([[q, -one, 0], [one, -q, -1], [0, 0, q]], (ea, ga, eiz), (ra, ra, ri[2]))  # (v_x sin, v_y cos, phi_z sin)
            out = fourier([[-q, 1, 0], [0, -one, -q], [0, q, one]], (ga, gj, eiy), (ra, ri[1], ri[0]))  # (v_z cos, phi_y sin, phi_x cos)
            if n == 0:  # the sine fields vanish
                plane, out = [mp.sqrt(ea / (mp.mpf(ra) * radius ** 2))], [mp.sqrt(eiy / (mp.mpf(ri[0]) * radius ** 2))]
            for what, found in (("in", plane), ("out", out)):
                off = around(found[0], n, radius, *data)
                print(f"{name} ring, n = {n}, {what} of plane; transfer matrix, relative:", mp.nstr(off, 1))
                assert off < 1e-14
                rows += [[name, what, n, branch + 1, float(w)] for branch, w in enumerate(found)]
    store("ring_frequencies", "Closed steel ring of radius 1 m, circular section",
          [word("ring", "diameter 0.01 m (thin) or 0.2 m (thick)"), word("plane", "in the ring's plane, or out of it"),
           Field("n", "1", "waves around; each n > 0 has two modes, sine and cosine, n = 0 one"),
           Field("branch", "1", "from the lowest on")],
          rows, "all digits of double precision",
          "3x3 Fourier matrices with 30 digits; roots of the transfer matrix with 100 digits", 1e-13)


def fourier(strain, stiffness, mass):
    b = mp.matrix(strain)
    root = [1 / mp.sqrt(mp.mpf(v)) for v in mass]
    k = b.T * mp.diag(list(stiffness)) * b
    values = mp.eigsy(mp.matrix(3, 3) + mp.diag(root) * k * mp.diag(root), eigvals_only=True)
    return [mp.sqrt(v) for v in values if v > max(values) * mp.mpf("1e-20")]


def circle(d, young=2e11, nu=0.3, rho=7800.0):
    area, second = np.pi * d * d / 4, np.pi * d ** 4 / 64
    shear = young / (2 * (1 + nu))
    return young * area, shear * area, 2 * shear * second, young * second, young * second, rho * area, rho * second * np.array([2.0, 1, 1])


def around(w, n, radius, ea, ga, gj, eiy, eiz, ra, ri):
    """Relative distance of w from a root of det(exp(B s) -+ 1): the determinant at w against that at w (1 + 1e-6). Mode n changes
    its sign after s = pi R/n; the root is double (sine and cosine), for n = 0 single with s = 2 pi R."""
    def value(w):
        b = mp.zeros(12)  # (v, phi, n, m) in the section's basis: y' + kappa x y = ...
        for i in range(4):
            b[3 * i, 3 * i + 1], b[3 * i + 1, 3 * i] = 1 / mp.mpf(radius), -1 / mp.mpf(radius)
        b[1, 5], b[2, 4], b[10, 8], b[11, 7] = 1, -1, 1, -1
        for i, (c, k) in enumerate(zip((ea, ga, ga), (gj, eiy, eiz))):
            b[i, 6 + i], b[3 + i, 9 + i] = 1 / mp.mpf(c), 1 / mp.mpf(k)
            b[6 + i, i], b[9 + i, 3 + i] = -w * w * ra, -w * w * mp.mpf(ri[i])
        t = mp.expm(b * mp.pi * radius / n if n else b * 2 * mp.pi * radius)
        return abs(mp.det(t + (mp.eye(12) if n else -mp.eye(12))))
    with mp.workdps(100):
        ratio = value(w) / value(w * (1 + mp.mpf("1e-6")))
        return mp.mpf("1e-6") * (mp.sqrt(ratio) if n else ratio)


if __name__ == "__main__":
    straight()
    tip()
    frame()
    ring()
