"""OpenSees on the static problems: straight two-node elements with the corotational transformation.

`forceBeamColumn` with an elastic section, whose shear is that of the exact answer; `elasticBeamColumn` has none, and its error
ends at 2.6e-3 on the bend. Two Gauss points are exact for an elastic section. Nodes on the curve, chords between them.
Newton's method to 1e-8 in the displacements, banded LU. Increments of the load grow by half after each and are a third
after a failure, from 1e-4 for the spring: that is twice as fast as the 500 equal ones it needs otherwise (100 fail).
The bend takes the fewest equal increments that converge. The time is that of all calls of `analyze`.
"""

import sys
from math import cos, pi, sin

import measure

try:
    import openseespy.opensees as ops
except (ImportError, OSError, RuntimeError) as error:
    sys.exit(f"OpenSees cannot be imported: {error}\nits wheel needs Python 3.11 and the system's libblas and liblapack; on "
             "Debian `apt-get install libblas3 liblapack3`")


def arc(x):
    a = pi / 4 * x
    return [100 * sin(a), 100 * (1 - cos(a)), 0.0]


def helix(x):
    a, slope = 20 * pi * x, 5e-3 / (2 * pi * 10e-3)
    return [10e-3 * sin(a), -10e-3 * cos(a), 10e-3 * slope * a]


def build(curve, elements, young, shear, area, bending, torsion, force):
    """The clamped rod with its load; e_z of a section lies along the axis the curve winds about, as far as it can."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    for k in range(elements + 1):
        ops.node(k + 1, *curve(k / elements))
    ops.fix(1, *[1] * 6)
    # E, A, Iz, Iy, G, J and the shares of the area that carry shear.
    ops.section("Elastic", 1, young, area, bending, bending, shear, torsion, 1.0, 1.0)
    ops.beamIntegration("Legendre", 1, 1, 2)
    for k in range(1, elements + 1):
        ops.geomTransf("Corotational", k, 0.0, 0.0, 1.0)
        ops.element("forceBeamColumn", k, k, k + 1, k, 1)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(elements + 1, 0.0, 0.0, force, 0.0, 0.0, 0.0)
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-8, 30)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")


def equal(increments):
    """True if all of them converge."""
    ops.integrator("LoadControl", 1 / increments)
    return ops.analyze(increments) == 0


def growing(first):
    factor, step = 0.0, first
    while factor < 1 - 1e-12:
        now = 1 - factor if 1 - factor < 1.2 * step else step
        ops.integrator("LoadControl", now)
        if ops.analyze(1) == 0:
            factor, step = factor + now, 1.5 * now
        else:
            step = now / 3
            if step < 1e-9:
                return False
    return True


def solved(curve, elements, numbers, exact, place, solve):
    """Seconds and error; infinite seconds if it does not converge."""
    build(curve, elements, *numbers)
    seconds, converged = measure.timed(solve)
    end = ops.nodeDisp(elements + 1)[:3]
    if place:
        end = [a + b for a, b in zip(end, ops.nodeCoord(elements + 1))]
    return (seconds, measure.math.dist(end, exact)) if converged else (measure.math.inf, None)


def main():
    quick = measure.quick()
    bend = 1e7, 5e6, 1.0, 1 / 12, 1 / 6, 600.0
    exact = measure.bend_tip()
    for n in (8, 16) if quick else (8, 16, 32, 64, 128):
        for increments in 1, 2, 3, 5, 10, 20:
            once = lambda: solved(arc, n, bend, exact, True, lambda: equal(increments))
            if once()[1] is not None:
                seconds, error = measure.fastest(once, quick)
                measure.tell("bend", "OpenSees", f"{n} elements, {increments} increments", seconds, error)
                break
    second = pi * 1e-3**4 / 64
    spring = 1e11, 1e11 / 2.4, pi * 1e-3**2 / 4, second, 2 * second, 100.0
    exact = measure.spring_tip()
    for n in (75,) if quick else (75, 150, 300):
        seconds, error = measure.fastest(lambda: solved(helix, n, spring, exact, False, lambda: growing(1e-4)), quick)
        if error is not None:
            measure.tell("spring", "OpenSees", f"{n} elements", seconds, error)


if __name__ == "__main__":
    main()
