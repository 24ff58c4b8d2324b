"""The soft cantilever of scripts/references/pyelastica_rods.py, from the descriptor of its data."""

import json
from math import pi

from measure import REFERENCES


def parameters():
    """Those stored, the stiffness of the section (EA, GA, GA, GJ, EI, EI) and its inertia."""
    entries = json.loads((REFERENCES / "pyelastica" / "datapackage.json").read_text(encoding="utf-8"))["resources"]
    given = dict(next(entry["parameters"] for entry in entries if entry["name"] == "soft_cantilever"))
    young, density = given["young_modulus"], given["density"]
    shear = young / (2 * (1 + given["poisson_ratio"]))
    area = pi * given["radius"] ** 2
    second = area * given["radius"] ** 2 / 4
    cut = given["shear_factor"] * shear * area
    axial = given["axial_factor"] * young * area
    given["stiffness"] = [axial, cut, cut, 2 * shear * second, young * second, young * second]
    given["mass_per_length"] = density * area
    given["rotary_inertia"] = [2 * density * second, density * second, density * second]
    return given
