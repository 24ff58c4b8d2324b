"""Typed-in figures: printed tables of papers, and what other people's programs have printed.

Nothing is computed here. Every figure comes with half a unit of its last digit; where a page or a table is not known
it says so. The grade is B throughout: the figures carry the mesh errors of those who printed them.
"""

from decimal import Decimal

from datapackage import Field, Table, root

UNKNOWN = "not stated"


def half_unit(figure):
    """Half a unit of the last digit of a figure as it is printed."""
    return float(Decimal("0.5").scaleb(Decimal(figure).as_tuple().exponent))


def keys(**descriptions):
    """Key columns: name=(unit, description), words where the unit is 'word'."""
    return [Field(name, "1" if unit == "word" else unit, text, type="string" if unit == "word" else "number")
            for name, (unit, text) in descriptions.items()]


def figures(source, name, title, publication, key_fields, value_fields, rows, parameters=None):
    """Stores rows of (keys, printed figures); every figure gets a column `name_half_digit`."""
    columns = list(key_fields)
    for column, unit, description in value_fields:
        columns += [Field(column, unit, description),
                    Field(f"{column}_half_digit", unit, f"half a unit of the last printed digit of {column}")]
    entries = [[*key, *(number for figure in printed for number in (float(figure), half_unit(figure)))]
               for key, printed in rows]
    Table(
        source=source,
        name=name,
        title=title,
        fields=columns,
        rows=entries,
        accuracy="half a unit of the last printed digit; the meshes of those who printed it on top",
        accuracy_method="typed in as printed",
        parameters=parameters or {},
        publication={"table": UNKNOWN, "page": UNKNOWN, "grade": "B"} | publication,
    ).write(root())


def bends():
    axes = "x towards the centre of the arc, y along its first tangent, z out of its plane"
    force = keys(force=("N", "dead tip force along z"))
    components = [(name, "m", f"{{}}, component {name}") for name in "xyz"]
    described = lambda what: [(name, unit, text.format(what)) for name, unit, text in components]
    mesh = {"axes": axes, "elements": 8, "nodes_per_element": 2, "radius": 100, "young_modulus": 1e7}
    figures("published", "bathe_bolourchi_1979", "45 degree bend: displacement of the tip",
            {"title": "K.-J. Bathe & S. Bolourchi, Large displacement analysis of three-dimensional beam structures, "
                      "Int. J. Numer. Methods Eng. 14 (1979)"},
            force, described("displacement of the tip"), [([600.0], ["-13.4", "-23.5", "53.4"])], mesh)
    figures("published", "simo_vu_quoc_1986", "45 degree bend: place of the tip",
            {"title": "J. C. Simo & L. Vu-Quoc, A three-dimensional finite-strain rod model, part II, Comput. Methods "
                      "Appl. Mech. Eng. 58 (1986), section 5.3"},
            force, described("tip"), [([600.0], ["15.79", "47.23", "53.37"])], mesh)


def princeton():
    figures("published", "ansys_princeton", "Princeton beam: displacement of the tip",
            {"title": "ANSYS, 199 beam elements; torsion constant of its own, not printed"},
            keys(degrees=("degree", "angle of the force to the stiff direction")),
            [("y", "m", "|displacement| along the stiff direction"), ("z", "m", "|displacement| across it")],
            [([45.0], ["0.008837226", "0.108987937"])], {"elements": 199})


def right_angle_cantilever():
    rows = [(["tip"], ["7.44", "8.25"]), (["tip"], ["15.87", "-9.73"]), (["elbow"], ["10.87", "-4.06"])]
    figures("published", "simo_vu_quoc_1988", "Right-angle cantilever: extrema of the displacement out of the plane",
            {"title": "J. C. Simo & L. Vu-Quoc, On the dynamics in space of rods undergoing large motions, Comput. "
                      "Methods Appl. Mech. Eng. 66 (1988)"},
            keys(point=("word", "elbow or tip")), [("time", "s", "time of the extremum"), ("z", "m", "displacement there")],
            rows, {"elements_per_leg": 40, "time_step": 0.005})


PROGRAM = {"title": "Program of the authors of Harsch & Eugster, Non-unit quaternion parametrization of a Petrov-Galerkin "
                    "Cosserat rod finite element; figures it prints"}


def spring():
    forces = (5.0, 10.0, 20.0, 50.0, 100.0)
    key, value = keys(force=("N", "dead force along e_z at the end of the wire")), [("z", "mm", "its displacement along e_z")]
    common = {"section": "4.1", "increments": 500, "tolerance": 1e-8}
    printed = ("79.481", "149.932", "271.775", "498.823", "572.243")
    figures("authors", "spring_r12", "Helical spring, R12 interpolation", PROGRAM, key, value,
            [([force], [figure]) for force, figure in zip(forces, printed)],
            common | {"elements": 75, "degree": 2, "samples": 301, "quadrature_points": 2})
    printed = ("79.563", "150.242", "272.494", "499.970", "572.612")
    figures("authors", "spring_se3", "Helical spring, SE(3) interpolation", PROGRAM, key, value,
            [([force], [figure]) for force, figure in zip(forces, printed)],
            common | {"elements": 150, "degree": 1, "samples": 151, "quadrature_points": 2})


def wilberforce():
    run = {"section": "4.2", "elements": 18, "degree": 2, "samples": 45, "time_step": 5e-3, "spectral_radius": 0.8,
           "tolerance": 1e-8, "alpha": "atan2(-A_12, A_11) of A_IK, unwrapped"}
    table = [("-89.597", "0.1959"), ("-71.769", "0.4142"), ("-24.525", "-0.1276"), ("-99.859", "0.0710"),
             ("-51.971", "0.6809"), ("-39.985", "-0.5746"), ("-100.578", "0.3527"), ("-35.774", "0.7819")]
    figures("authors", "wilberforce", "Wilberforce pendulum at whole seconds", PROGRAM, keys(time=("s", "time")),
            [("z", "mm", "centre of mass of the bob, vertical"), ("alpha", "rad", "turn of the bob about the vertical")],
            [([float(k + 1)], list(row)) for k, row in enumerate(table)], run)
    envelope = "half the difference of consecutive extrema, each by a parabola through three samples, at their mid-time"
    for name, unit, rows in (
        ("z", "mm", [("smallest", "1.823", "18.6"), ("largest", "3.642", "42.4")]),
        ("alpha", "rad", [("largest", "1.817", "2.368")]),
    ):
        figures("authors", f"wilberforce_envelope_{name}", f"Wilberforce pendulum: where the envelope of {name} turns",
                PROGRAM, keys(which=("word", "smallest or largest")),
                [("time", "s", "time"), ("value", unit, "half the swing there")],
                [([which], [time, value]) for which, time, value in rows], run | {"envelope": envelope})


def exudyn_wilberforce():
    """Other than `exudyn_wilberforce.py`, which extrapolates in mesh and step: one run of 8 s, with its errors."""
    publication = {"title": "Exudyn, geometrically exact beam elements; figures of one run"}
    run = {"section": "4.2", "elements": 48, "nodes_per_element": 2, "time_step": 5e-3,
           "yaw": "atan2(A_21, A_11), unwrapped"}
    for name, unit, what, rows in (
        ("z", "m", "centre of mass of the bob, vertical",
         [("0.2047", "-0.10389"), ("0.4109", "-0.02088"), ("1.918", "-0.08277"), ("3.6011", "-0.10323")]),
        ("yaw", "rad", "turn of the bob about the vertical", [("0.6990", "1.4843"), ("1.8988", "2.4282")]),
    ):
        figures("published", f"exudyn_wilberforce_{name}", f"Wilberforce pendulum: extrema of {name}", publication, [],
                [("time", "s", "time of the extremum"), ("value", unit, what)], [([], row) for row in rows], run)


def main():
    bends()
    princeton()
    right_angle_cantilever()
    spring()
    wilberforce()
    exudyn_wilberforce()


if __name__ == "__main__":
    main()
