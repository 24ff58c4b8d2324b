"""Reference data and where it comes from: a CSV file and its entry in the folder's Frictionless `datapackage.json`.

A script of this folder makes one or more tables and stores each with `Table.write(root)`; `root` is the folder
`references/`, or any other that `scripts/regenerate` names. The tables of one source share a folder and a descriptor.
"""

import csv
import hashlib
import importlib.metadata
import json
import math
import platform
import sys
from dataclasses import dataclass, field
from pathlib import Path

LICENCES = {
    "CC0-1.0": {
        "name": "CC0-1.0",
        "title": "CC0 1.0 Universal: computed figures, free to use",
        "path": "https://creativecommons.org/publicdomain/zero/1.0/",
    },
}

TITLES = {
    "authors": "Figures of the program of the paper's authors",
    "continuous": "The continuous rod equations, solved without finite elements",
    "exudyn": "Exudyn: rigid bodies, joints and geometrically exact beams",
    "mujoco": "MuJoCo: rigid bodies and joints in minimal coordinates",
    "pinocchio": "Pinocchio: maps of rotations and motions, one free rigid body",
    "published": "Published tables and figures, typed in",
    "pyelastica": "PyElastica: discrete elastic rods, explicit dynamics",
    "rigid": "Equations of motion of rigid bodies, in closed form or minimal coordinates",
    "scipy": "SciPy: the paper's fit of the reference, eq. (21), as a problem of least squares",
}


@dataclass
class Field:
    """One column. `tolerance` is how far `scripts/regenerate --check` may find it moved, in its unit; None: exactly equal."""

    name: str
    unit: str
    description: str
    tolerance: float | None = None
    relative_tolerance: float | None = None
    type: str = "number"

    def descriptor(self):
        entry = {"name": self.name, "type": self.type, "unit": self.unit, "description": self.description}
        if self.tolerance is not None:
            entry["tolerance"] = self.tolerance
        if self.relative_tolerance is not None:
            entry["relativeTolerance"] = self.relative_tolerance
        return entry


def fields(names, unit, description, tolerance=None, relative_tolerance=None):
    """Several columns of one kind: `fields("x y z", "m", "tip, component {}")`."""
    return [
        Field(name, unit, description.format(name), tolerance, relative_tolerance) for name in names.split()
    ]


@dataclass
class Table:
    """One CSV file `source/name.csv`."""

    source: str
    name: str
    title: str
    fields: list
    rows: list
    """What the numbers are good for, in words with figures in them, and how that was found out."""
    accuracy: str
    accuracy_method: str
    """What the script set: time steps, elements, tolerances, seeds."""
    parameters: dict = field(default_factory=dict)
    """Names of the installed packages that made the numbers; versions are looked up."""
    tools: list = field(default_factory=list)
    """A publication: {"title": …, "table": …, "page": …, "grade": …}."""
    publication: dict | None = None
    licence: str = "CC0-1.0"

    def write(self, root):
        """Writes the file and replaces its entry in the descriptor beside it."""
        names = [column.name for column in self.fields]
        if len(set(names)) != len(names):
            raise ValueError(f"{self.source}/{self.name}: two columns of one name")
        folder = Path(root) / self.source
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{self.name}.csv"
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(names)
            for number, row in enumerate(self.rows):
                if len(row) != len(names):
                    raise ValueError(f"{path}, row {number}: {len(row)} values for {len(names)} columns")
                writer.writerow([text(value, f"{path}, row {number}") for value in row])
        store(folder, self.source, self.descriptor(path))

    def descriptor(self, path):
        content = path.read_bytes()
        versions = {tool: importlib.metadata.version(tool) for tool in self.tools}
        if not self.publication:
            versions = {"python": platform.python_version()} | versions
        return {
            "name": self.name,
            "title": self.title,
            "path": path.name,
            "format": "csv",
            "mediatype": "text/csv",
            "encoding": "utf-8",
            "bytes": len(content),
            "hash": "sha256:" + hashlib.sha256(content).hexdigest(),
            "licenses": [LICENCES[self.licence]],
            **({"sources": [self.publication]} if self.publication else {}),
            "script": "scripts/references/" + Path(sys.argv[0]).name,
            "parameters": self.parameters,
            "tools": versions,
            "accuracy": self.accuracy,
            "accuracyMethod": self.accuracy_method,
            "schema": {"fields": [column.descriptor() for column in self.fields]},
        }


def text(value, where):
    """Shortest digits that read back exactly; words as they are (digits beyond double precision come as words)."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        raise ValueError(f"{where}: neither number nor text")
    if isinstance(value, int):
        return str(value)
    value = float(value)
    if not math.isfinite(value):
        raise ValueError(f"{where}: {value}")
    return repr(value)


def store(folder, source, entry):
    path = folder / "datapackage.json"
    package = {"name": source, "title": TITLES[source], "resources": []}
    if path.exists():
        package["resources"] = json.loads(path.read_text(encoding="utf-8"))["resources"]
    others = [resource for resource in package["resources"] if resource["name"] != entry["name"]]
    package["resources"] = sorted(others + [entry], key=lambda resource: resource["name"])
    path.write_text(json.dumps(package, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def root():
    """The folder that the command line names."""
    if len(sys.argv) != 2:
        sys.exit(f"usage: {Path(sys.argv[0]).name} FOLDER   (the folder `references`)")
    return Path(sys.argv[1])
