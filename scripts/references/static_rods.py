"""Static Cosserat rods, clamped and loaded, by the continuous equations of `rod_equations.py`: no finite elements.

Every rod is solved in three ways, by collocation of two orders and by multiple shooting; what the tables say about
their accuracy is asserted for the differences of the three.
"""

import numpy as np

from datapackage import Field, Table, fields, root
from rod_equations import ACCURACY, MORE_STAGES, STAGES, ZERO, Rod, follow, turn


def square(young, shear, width, torsion_constant=None):
    """EA, GA, GA and GJ, EI, EI of a square section."""
    area, second = width**2, width**4 / 12
    return (young * area, shear * area, shear * area), (shear * (torsion_constant or 2 * second), *2 * [young * second])


def circle(young, shear, diameter):
    area, second = np.pi * diameter**2 / 4, np.pi * diameter**4 / 64
    return (young * area, shear * area, shear * area), (2 * shear * second, young * second, young * second)


def helix(radius, pitch, coils):
    """Length, curvature and clamp of r = (R sin p, -R cos p, R c p), c = pitch/(2 pi R), with the Serret-Frenet frame."""
    c = pitch / (2 * np.pi * radius)
    stretch, half = np.hypot(1, c), np.arctan(c) / 2
    return {
        "length": 2 * np.pi * coils * radius * stretch,
        "curvature": (c / (radius * stretch**2), 0.0, 1 / (radius * stretch**2)),
        "position": (0.0, -radius, 0.0),
        "quaternion": (np.cos(half), 0.0, -np.sin(half), 0.0),
    }


YOUNG, SHEAR, DIAMETER, RADIUS, PITCH, COILS = 1e11, 1e11 / 2.4, 1e-3, 10e-3, 5e-3, 10


def spring(**loads):
    """The helical spring of Harsch & Eugster, section 4.1."""
    force, moment = circle(YOUNG, SHEAR, DIAMETER)
    return Rod(**helix(RADIUS, PITCH, COILS), force_stiffness=force, moment_stiffness=moment, intervals=160, **loads)


def bend(width, torsion_constant, force):
    """45 degree bend, Bathe & Bolourchi: from the origin along e_x, bent towards e_y, force along e_z."""
    sections = square(1e7, 5e6, width, torsion_constant)
    return Rod(100 * np.pi / 4, *sections, curvature=(0.0, 0.0, 0.01), force=(0.0, 0.0, force))


def princeton(degrees):
    """Thin strip along e_x, w along e_y, h along e_z, J = 0.198 (I_y + I_z), 8.896 N."""
    width, height, young, beta = 12.3777e-3, 3.2024e-3, 71.7e9, np.radians(degrees)
    area, shear = width * height, young / (2 * 1.31)
    about_y, about_z = area * height**2 / 12, area * width**2 / 12
    moments = (shear * 0.198 * (about_y + about_z), young * about_y, young * about_z)
    force = (0.0, -8.896 * np.cos(beta), 8.896 * np.sin(beta))
    return Rod(0.508, (young * area, shear * area, shear * area), moments, force=force)


def cantilever(theory, alpha_squared):
    """Straight, L = 2 pi, EI = 2, dead tip force alpha^2 EI/L^2 along e_y."""
    axial, shear = {"cosserat": (5.0, 1.0), "shear-rigid": (5.0, np.inf), "inextensible": (np.inf, np.inf)}[theory]
    length = 2 * np.pi
    return Rod(length, (axial, shear, shear), (1.0, 2.0, 2.0), force=(0.0, alpha_squared * 2 / length**2, 0.0))


def convergence(slenderness):
    """Harsch, Sailer & Eugster 2023, section 5.1: body end moment (EI 2 pi/L)/4 about e_3, dead tip force moment/L along e_3."""
    length = 1000.0
    forces, moments = square(1.0, 0.5, length / slenderness)
    moment = moments[2] * 2 * np.pi / length / 4
    return Rod(length, forces, moments, body_moment=(0.0, 0.0, moment), force=(0.0, 0.0, moment / length))


def two_coils(slenderness, force=ZERO):
    """A straight rod that a body end moment makes a helix of two coils; a dead tip force in EI/L^2 on top."""
    shape = helix(10.0, 25.0, 2)
    length, curvature = shape["length"], np.array(shape.pop("curvature"))
    forces, moments = circle(1.0, 0.5, length / slenderness)
    force = tuple(np.array(force) * moments[1] / length**2)
    return Rod(**shape, force_stiffness=forces, moment_stiffness=moments, force=force,
               body_moment=tuple(curvature * moments))


UNEVEN = {"force_stiffness": (1e4, 4e3, 5e3), "moment_stiffness": (0.8, 1.0, 1.5)}
# Every kind of load at least once, all of them three-dimensional, on a straight rod of 2 m and on a helix.
PROBLEMS = {
    "dead line force, dead tip moment": {"line_force": (0.3, -1.0, 0.8), "moment": (0.6, 0.8, 2.0)},
    "body line force": {"body_line_force": (0.2, -1.2, 0.9)},
    "dead line moment": {"line_moment": (0.5, 1.2, 1.6)},
    "body line moment": {"body_line_moment": (0.5, 0.6, 5.0)},
    "dead tip force, body tip moment": {"force": (0.2, -0.6, 0.9), "body_moment": (0.6, 0.8, 4.5)},
    "body tip force": {"body_force": (0.1, -1.3, 0.9)},
    "all on a helix": {
        "force": (0.3, 0.2, 0.8),
        "body_force": (0.1, 0.1, 0.2),
        "lever": (0.1, 0.2, -0.15),
        "moment": (0.2, -0.3, 0.4),
        "body_moment": (0.1, 0.3, -0.5),
        "line_force": (0.1, -0.2, -0.3),
        "body_line_force": (0.1, 0.2, 0.1),
        "line_moment": (0.1, 0.05, -0.1),
        "body_line_moment": (-0.1, 0.1, 0.2),
    },
}


def loaded(name):
    shape = helix(0.3, 0.25, 1.5) if "helix" in name else {"length": 2.0}
    return Rod(**shape, **UNEVEN, **PROBLEMS[name])


def accuracies(solutions, kinds):
    return [[solution.accuracy[kind] for kind in kinds] for solution in solutions]


def pose_fields(what, length):
    tolerance = 0.5 * ACCURACY["position"] * length
    return (fields("x y z", "m", f"{what}, component {{}} in the inertial basis", tolerance)
            + fields("qw qx qy qz", "1", f"rotation of the section of the {what}, unit quaternion, component {{}}",
                     0.5 * ACCURACY["rotation"]))


def clamp_fields(solutions):
    largest = {kind: max(solution.accuracy[kind] for solution in solutions) for kind in ("force", "moment")}
    return (fields("fx fy fz", "N", "force of the clamp on the rod, {}", 0.5 * largest["force"])
            + fields("mx my mz", "N m", "moment of the clamp on the rod, about the clamp, {}", 0.5 * largest["moment"]))


UNITS = {"position": "m", "rotation": "rad", "force": "N", "moment": "N m"}


def accuracy_fields(kinds):
    return [Field(f"{kind}_accuracy", UNITS[kind], f"largest error of the {kind}s of this row", relative_tolerance=1e-6)
            for kind in kinds]


def store(name, title, parameters, keys, entries, length, *, reactions=True, what="tip", origin=ZERO):
    """A table of tips: `entries` are (key values, solution); with `origin` a displacement is stored."""
    solutions = [solution for _, solution in entries]
    kinds = list(ACCURACY) if reactions else ["position", "rotation"]
    rows = []
    for (key, solution), accuracy in zip(entries, accuracies(solutions, kinds)):
        x, y, z, *quaternion = solution.pose()
        lever = turn(np.array(quaternion), np.array(parameters.get("lever", ZERO)))
        place = np.array([x, y, z]) + lever - origin
        rows.append([*key, *place, *quaternion, *(solution.clamp if reactions else []), *accuracy])
    columns = keys + pose_fields(what, length) + (clamp_fields(solutions) if reactions else []) + accuracy_fields(kinds)
    write(name, title, parameters, columns, rows, solutions)


def write(name, title, parameters, columns, rows, solutions):
    seen = {kind: max(solution.differences[kind] for solution in solutions) for kind in ACCURACY}
    stages = f"Gauss collocation with {STAGES} and {MORE_STAGES} stages an interval, multiple shooting with DOP853"
    Table(
        source="continuous",
        name=name,
        title=title,
        fields=columns,
        rows=rows,
        accuracy="The columns of accuracy: {position:g} of the length for positions, {rotation:g} rad for rotations, "
        "{force:g} of the largest resultant force of the row (or EI/L^2) and of the largest moment (or EI/L).".format(
            **ACCURACY),
        accuracy_method=f"{stages}: the largest differences of the three were below these (asserted), and of the order of "
        + ", ".join(f"1e{np.ceil(np.log10(max(value, 1e-16))):.0f} ({kind})" for kind, value in seen.items()) + ".",
        parameters=parameters,
        tools=["numpy", "scipy"],
    ).write(root())


def springs():
    """The spring by its wire end and on its axis, and the whole wire at two loads."""
    given = {"young_modulus": YOUNG, "poisson_ratio": 0.2, "diameter": DIAMETER, "radius": RADIUS, "pitch": PITCH,
             "coils": COILS, "clamp": "xi = 0, at (0, -R, 0)", "force": "dead, along e_z, at xi = 1"}
    key = [Field("force", "N", "force along e_z")]
    end = np.array([0.0, -RADIUS, COILS * PITCH])
    length = spring().length
    forces = np.array([1e-3, 1.0, 5.0, 10.0, 20.0, 50.0, 100.0])
    found = follow(spring(force=(0.0, 0.0, 100.0)), forces / 100)
    store("static_spring_wire_end", "Helical spring pulled at the end of the wire", given, key,
          [([force], solution) for force, solution in zip(forces, found)], length,
          what="displacement of the wire end", origin=end)
    stations = range(0, 161, 8)
    rows = [[forces[k], i / 160, *found[k].pose(i), *accuracy] for k in (3, 6)
            for accuracy in accuracies([found[k]], ["position", "rotation"]) for i in stations]
    columns = key + [Field("xi", "1", "reference arc length over that of the wire")]
    columns += pose_fields("centreline", length) + accuracy_fields(["position", "rotation"])
    write("static_spring_shape", "The whole wire of the spring pulled at its end", given, columns, rows, found)
    lever = (0.0, RADIUS, 0.0)
    forces = np.array([1e-3, 0.1, 1.0, 10.0, 100.0])
    found = follow(spring(force=(0.0, 0.0, 100.0), lever=lever), forces / 100)
    store("static_spring_axis", "Helical spring pulled on its axis, through a rigid lever from the wire end",
          given | {"lever": lever}, key, [([force], solution) for force, solution in zip(forces, found)], length,
          what="displacement of the loaded point", origin=end + lever)


def bends():
    given = {"radius": 100, "angle": "pi/4", "young_modulus": 1e7, "poisson_ratio": 0, "shear_factor": 1,
             "axes": "the arc starts at the origin along e_x and bends towards e_y; dead force along e_z at its end"}
    forces = np.arange(1, 9) * 75.0
    entries = []
    for name, torsion_constant in (("1/6", 1 / 6), ("0.141", 0.141)):
        for force, solution in zip(forces, follow(bend(1.0, torsion_constant, 600.0), forces / 600)):
            entries.append(([name, torsion_constant, force], solution))
    keys = [Field("case", "1", "J in words", type="string"), Field("torsion_constant", "m^4", "J of the unit square"),
            Field("force", "N", "tip force")]
    length = 100 * np.pi / 4
    store("static_bend_45", "45 degree bend with a unit square section", given, keys, entries, length)
    entries = []
    for slenderness, force in ((1e1, 6e6), (1e2, 6e2), (1e3, 6e-2), (1e4, 6e-6)):
        width = 100 / slenderness
        entries.append(([width, force], follow(bend(width, None, force))[0]))
    keys = [Field("width", "m", "side of the square; J = width^4/6"), Field("force", "N", "tip force")]
    store("static_bend_45_slenderness", "45 degree bend, slenderness 1e1 to 1e4", given, keys, entries, length,
          reactions=False)


def beams():
    """Princeton beam and shear-soft cantilever."""
    factors = (0.25, 0.5, 0.75, 1.0)
    factor = Field("factor", "1", "share of the load")
    entries = [([float(degrees), solution.factor], solution) for degrees in (30, 45, 90)
               for solution in follow(princeton(degrees), factors)]
    given = {"length": 0.508, "width": 12.3777e-3, "height": 3.2024e-3, "young_modulus": 71.7e9, "poisson_ratio": 0.31,
             "torsion_constant": "0.198 (I_y + I_z)", "shear_factor": 1, "force": 8.896}
    keys = [Field("degrees", "degree", "angle beta of the force (0, -F cos beta, F sin beta)"), factor]
    store("static_princeton", "Princeton beam", given, keys, entries, 0.508)
    runs = (("cosserat", "10/9", 10 / 9), ("cosserat", "5", 5.0), ("cosserat", "10", 10.0), ("shear-rigid", "10", 10.0),
            ("inextensible", "10/3", 10 / 3), ("inextensible", "10", 10.0))
    entries = [([theory, words, solution.factor], solution) for theory, words, value in runs
               for solution in follow(cantilever(theory, value), factors)]
    keys = [Field("theory", "1", "strains that are ruled out", type="string"),
            Field("alpha_squared", "1", "F L^2/EI in words", type="string"), factor]
    given = {"length": "2 pi", "axial": 5, "shear": 1, "torsion": 1, "bending": 2, "force": "dead, along e_y"}
    store("static_cantilever", "Straight cantilever under a dead tip force", given, keys, entries, 2 * np.pi)


def moments():
    """Body-fixed end moments with dead tip forces."""
    factor = Field("factor", "1", "share of the load")
    key = [Field("slenderness", "1", "length over width of the section"), factor]
    factors = (0.25, 0.5, 0.75, 1.0)
    entries = [([slenderness, solution.factor], solution) for slenderness in (1e2, 1e4)
               for solution in follow(convergence(slenderness), factors)]
    given = {"length": 1000, "young_modulus": 1, "shear_modulus": 0.5, "section": "square", "shear_factor": 1,
             "body_moment": "(EI 2 pi/L)/4 about e_3", "force": "dead, moment/L along e_3"}
    store("static_quarter_turn", "Straight rod with a body-fixed end moment and a dead tip force", given, key, entries,
          1000.0, reactions=False)
    push = (2.0, -6.0, 9.0)
    for slenderness in (1e1, 1e4):
        tip = follow(two_coils(slenderness))[0]
        if np.abs(tip.position[-1] - [0, -10, 50]).max() > 2 * tip.accuracy["position"]:
            raise ArithmeticError("the closed form of the helix is missed")
    entries = [([slenderness, solution.factor], solution) for slenderness in (1e2, 1e4)
               for solution in follow(two_coils(slenderness, push), factors)]
    given = {"radius": 10, "pitch": 25, "coils": 2, "young_modulus": 1, "shear_modulus": 0.5, "section": "circle",
             "body_moment": "R (4 pi/L)^2 (c GI_p, 0, EI)", "force": f"dead, {push} EI/L^2",
             "clamp": "(0, -10, 0), e_x = (1, 0, c)/sqrt(1 + c^2), e_y = (0, 1, 0)"}
    store("static_two_coils", "Straight rod bent past two turns by a body-fixed end moment, pulled by a dead tip force",
          given, key, entries, two_coils(1e2).length, reactions=False)


def loads():
    """Every kind of load: tips and clamps along the path, whole rods at its end."""
    entries, rows, last = [], [], []
    for name in PROBLEMS:
        rod = loaded(name)
        found = follow(rod, np.arange(1, 11) / 10)
        entries += [([name, solution.factor], solution) for solution in found]
        last.append(found[-1])
        accuracy = accuracies(last[-1:], ["position", "rotation"])[0]
        rows += [[name, i / rod.intervals, *last[-1].pose(i), *accuracy] for i in range(0, rod.intervals + 1, 4)]
    given = {"straight rod": "2 m along e_x, section's basis as the inertial one", "stiffness": UNEVEN,
             "helix": {"radius": 0.3, "pitch": 0.25, "coils": 1.5}, "loads": PROBLEMS,
             "names": "dead: components in the inertial basis; body: in the section's"}
    key = Field("problem", "1", "name of the loads, see the parameters", type="string")
    store("static_loads", "Rods under every kind of load: tip and clamp along the load path", given,
          [key, Field("factor", "1", "share of the load")], entries, 2.0)
    columns = [key, Field("xi", "1", "reference arc length over that of the rod")] + pose_fields("centreline", 2.0)
    write("static_shapes", "Rods under every kind of load: poses along the rod under the whole load", given,
          columns + accuracy_fields(["position", "rotation"]), rows, last)


def main():
    loads()
    bends()
    beams()
    moments()
    springs()


if __name__ == "__main__":
    main()
