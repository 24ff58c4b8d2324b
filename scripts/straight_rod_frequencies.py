"""Natural frequencies of Cosserat (Timoshenko) rods about their unstressed shape, without finite elements.

  single   straight rod, slender and stocky: bending (rotary inertia, shear factor 1), axial, torsional; cantilever, free-free,
           pinned-pinned.
  tip      cantilever with a rigid body at its end (centre of mass off the end, along the axis).
  frame    right-angle frame of two legs (data of Simo & Vu-Quoc 1988), clamped at one end.
  ring     closed circular ring: in plane and out of plane.

Bending in one plane: EI p'' + GA (w' - p) = rho I p_tt, GA (w'' - p') = rho A w_tt.
With b^2 = rho A w^2 L^4/EI, r^2 = rho I/(rho A L^2), s^2 = EI/(GA L^2), Huang's (1961) characteristic equations are
  clamped-free: 2 + (b^2 (r^2-s^2)^2 + 2) ch c - b (r^2+s^2)/sqrt(1-b^2r^2s^2) sh s = 0
  free-free:    2 - 2 ch c + b/sqrt(1-b^2r^2s^2) (b^2 r^2 (r^2-s^2)^2 + 3r^2 - s^2) sh s = 0
Pinned-pinned: (EI k^2 + GA - rho I w^2)(GA k^2 - rho A w^2) = GA^2 k^2, k = n pi/L.

Accuracy: `single` with 30 digits by Huang's equations, and again as the determinant of the transfer matrix exp(B L);
`tip` and `frame` by the 12x12 transfer matrix of the rods and by Ritz polynomials of two degrees (upper bounds);
`ring` by 3x3 Fourier matrices, and as roots of det(transfer matrix over half a wave + 1) with 100 digits.
Needs numpy, scipy, mpmath; half a minute.
"""

import mpmath as mp
import numpy as np
from scipy.linalg import eigh, expm
from scipy.optimize import brentq

mp.mp.dps = 30


def row(values, digits=14):
    return "[" + ", ".join(mp.nstr(mp.mpf(v), digits, min_fixed=-9, max_fixed=9) for v in values) + "]"


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
        rows, (c, d) = {"cantilever": ((2, 3), (2, 3)), "free-free": ((2, 3), (0, 1)), "pinned": ((0, 3), (1, 2))}[kind]
        return t[rows[0], c] * t[rows[1], d] - t[rows[0], d] * t[rows[1], c]
    return f


def single():
    for name, length, young, nu, rho, section in (
            ("slender: circle d 0.01, L 1, E 2e11, nu 0.3, rho 7800", 1, 2e11, "0.3", 7800, ("0.01",)),
            ("stocky: rectangle width 0.1 (e_y), height 0.2 (e_z), L 1, E 2e11, nu 0.3, rho 7800", 1, 2e11, "0.3", 7800, ("0.1", "0.2"))):
        young, nu, rho = mp.mpf(young), mp.mpf(nu), mp.mpf(rho)
        shear = young / (2 * (1 + nu))
        if len(section) == 1:
            d = mp.mpf(section[0])
            area = mp.pi * d ** 2 / 4
            second = {"": mp.pi * d ** 4 / 64}
        else:
            w, h = map(mp.mpf, section)
            area = w * h
            second = {" about e_y (I = w h^3/12)": w * h ** 3 / 12, " about e_z (I = h w^3/12)": h * w ** 3 / 12}
        print("\n==", name, " [rad/s]")
        for axis, inertia in second.items():
            data = young * inertia, shear * area, rho * area, rho * inertia, mp.mpf(length)
            euler = mp.sqrt(data[0] / data[2]) / length ** 2
            for kind, beta in (("cantilever", (1.87510407, 4.69409113, 7.85475744)), ("free-free", (4.73004074, 7.85320462, 10.99560784))):
                f = huang(kind, *data)
                start = euler * beta[0] ** 2 * mp.mpf("0.4")
                found = roots(f, start, euler * mp.mpf("0.9"), 4)
                g = determinant(kind, *data)
                tiny = mp.mpf("1e-18")
                same = all(mp.sign(g(v * (1 - tiny))) != mp.sign(g(v * (1 + tiny))) for v in found)
                print(f"bending{axis}, {kind}", row(found), " transfer matrix within 1e-18:", same,
                      " ratio to Euler-Bernoulli", row([v / (euler * b * b) for v, b in zip(found, beta)], 6))
            pinned = []
            for n in range(1, 5):
                k, (ei, ga, ra, ri, _) = n * mp.pi / length, data
                a, b, c = ra * ri, -(ra * (ei * k * k + ga) + ri * ga * k * k), ei * ga * k ** 4
                pinned.append(mp.sqrt((-b - mp.sqrt(b * b - 4 * a * c)) / (2 * a)))
            g = determinant("pinned", *data)
            same = all(mp.sign(g(v * (1 - tiny))) != mp.sign(g(v * (1 + tiny))) for v in pinned)
            print(f"bending{axis}, pinned-pinned", row(pinned), " transfer matrix within 1e-18:", same)
        wave = {"axial": mp.sqrt(young / rho), "torsional (torsion constant I_y + I_z: speed sqrt(G/rho))": mp.sqrt(shear / rho)}
        for what, c in wave.items():
            print(what, "cantilever", row([(2 * n - 1) * mp.pi * c / (2 * length) for n in (1, 2, 3)]),
                  "free-free", row([n * mp.pi * c / length for n in (1, 2, 3)]))
    # the Euler-Bernoulli limit: r = s -> 0
    for kind, beta in (("cantilever", ("1.87510406871196", "4.69409113297418", "7.85475743823761")), ("free-free", ("4.73004074486270", "7.85320462409584"))):
        f = huang(kind, mp.mpf(1), mp.mpf(10) ** 16, mp.mpf(1), mp.mpf(10) ** -16, mp.mpf(1))
        print("Euler-Bernoulli limit,", kind, row([mp.sqrt(v) for v in roots(f, 1.5, 1.1, len(beta))]), "expected", beta)


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


def report(title, rods, count, degrees, body=None):
    print("\n==", title, "[rad/s]")
    a, b = (ritz(rods, d, body)[:count] for d in degrees)
    c = shooting(rods, b, body)
    print(row(c, 13))
    print("Ritz, degrees", degrees, "differ by", np.abs(a / b - 1).max(), "; transfer matrix from Ritz", np.abs(c / b - 1).max())


def tip():
    w, h, young, rho = 0.1, 0.2, 2e11, 7800.0
    shear = young / 2.6
    area, iy, iz = w * h, w * h ** 3 / 12, h * w ** 3 / 12
    rod = Rod(np.eye(3), 1.0, [young * area, shear * area, shear * area], [shear * (iy + iz), young * iy, young * iz], rho * area,
              rho * np.array([iy + iz, iy, iz]))
    body = 50.0, np.diag([1.0, 2.0, 3.0]), np.array([0.15, 0, 0])
    report("stocky rod along +x with a body at its end: mass 50, inertia (1, 2, 3), centre of mass at x = 1.15", [rod], 8, (14, 18), body)
    body = 50.0, np.diag([1.0, 2.0, 3.0]), np.array([0.15, 0.1, -0.2])
    report("the same, centre of mass at (1.15, 0.1, -0.2): all directions coupled", [rod], 8, (14, 18), body)
    wave = np.sqrt(young / rho)
    k = [brentq(lambda k: k * np.tan(k) - rho * area / 50, *v, xtol=1e-15) for v in ((0.1, 1.57), (3.15, 4.71))]
    print("closed form, axial, first body (k tan k = rho A L/m):", row([v * wave for v in k]))
    c = np.sqrt(shear / rho)
    k = [brentq(lambda k: k * np.tan(k) - rho * (iy + iz) / 1.0, *v, xtol=1e-15) for v in ((0.1, 1.57), (3.15, 4.71))]
    print("closed form, torsional, first body (k tan k = rho J L/I_xx):", row([v * c for v in k]))


def frame():
    data = 10.0, [1e6] * 3, [1e3] * 3, 1.0, [20.0, 10, 10]
    first = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])  # e_x = +y, e_y = -x (default e_z cross tangent)
    report("right-angle frame (Simo & Vu-Quoc 1988), clamped at (0, 0, 0), elbow (0, 10, 0), tip (10, 10, 0)",
           [Rod(first, *data), Rod(np.eye(3), *data)], 10, (16, 20))


# ---------------------------------------------------------------- ring

def ring():
    for name, radius, ea, ga, gj, eiy, eiz, ra, ri in (
            ("thin: R 1, circle d 0.01, E 2e11, nu 0.3, rho 7800", 1.0, *circle(0.01)),
            ("thick: R 1, circle d 0.2", 1.0, *circle(0.2))):
        print("\n== closed ring,", name, "[rad/s]")
        for n in (0, 1, 2, 3, 4):
            q, one = mp.mpf(n) / radius, 1 / mp.mpf(radius)
            plane = fourier([[q, -one, 0], [one, -q, -1], [0, 0, q]], (ea, ga, eiz), (ra, ra, ri[2]))  # (v_x sin, v_y cos, phi_z sin)
            out = fourier([[-q, 1, 0], [0, -one, -q], [0, q, one]], (ga, gj, eiy), (ra, ri[1], ri[0]))  # (v_z cos, phi_y sin, phi_x cos)
            if n == 0:  # the sine fields vanish
                plane, out = [mp.sqrt(ea / (mp.mpf(ra) * radius ** 2))], [mp.sqrt(eiy / (mp.mpf(ri[0]) * radius ** 2))]
            for what, w in (("in plane", plane), ("out of plane", out)):
                euler = np.sqrt(eiz / (ra * radius ** 4) * n ** 2 * (n * n - 1) ** 2 / (n * n + 1)) if n > 1 and what == "in plane" else 0
                print(f"n = {n} {what}", row(w), f"Euler-Bernoulli, inextensible {euler:.12g} ratio {float(w[0] / euler):.8f}" if euler else "",
                      "transfer matrix, relative:", mp.nstr(around(w[0], n, radius, ea, ga, gj, eiy, eiz, ra, ri), 1))


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
    single()
    tip()
    frame()
    ring()
