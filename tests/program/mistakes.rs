//! Mistakes in a scene: one line each, so that the next one is easy to add.

pub mod moving;

/// A scene with every table; the cases below each spoil one place.
pub const GOOD: &str = r#"title = "all tables"
gravity = [0.0, 0.0, -9.81]

[[rod]]
name = "spring"
curve = { kind = "helix", coils = 2, radius = 10e-3, pitch = 5e-3, phase = 0.0 }
section = { kind = "circle", diameter = 1e-3, inner_diameter = 1e-4 }
material = { young_modulus = 1e11, poisson_ratio = 0.2, density = 7850 }
elements = 8
degree = 2
interpolation = "r12"
quadrature = "reduced"
reference = { kind = "fit", samples = 60 }
theory = "cosserat"
node_spacing = "equal"

[[rod]]
name = "beam"
elements = 3
degree = 1
gravity = false
[rod.curve]
kind = "line"
from = [1, 0, 0]
to = [1, 0, 1]
normal = [0, 1, 0]
[rod.section]
kind = "custom"
axial = 1e3
shear_y = 2e3
shear_z = 2e3
torsion = 0.1
bending_y = 0.2
bending_z = 0.3
mass_per_length = 0.5
rotary_inertia = [1e-6, 2e-6, 3e-6]

[[joint]]
name = "clamp"
kind = "rigid"
between = ["ground", "spring@0"]

[[joint]]
kind = "revolute"
between = ["beam@0", "ground"]
axis = [1, 0, 0]
point = [1, 0, 0]

[[joint]]
kind = "spherical"
between = ["ground", "beam@1"]

[[load]]
kind = "force"
on = "spring@1"
value = [0, 0, 0.01]
basis = "body"
offset = [0, 1e-3, 0]
time = [
    [0.0, 0.0],
    [0.5, 1.0],
]

[[load]]
kind = "line_moment"
on = "beam"
value = [0, 1e-3, 0]
time = "ramp"

[[probe]]
name = "tip"
on = "spring@1"
offset = [0, 0, 0]
angles = "zyx"

[[probe]]
name = "middle"
on = "beam@0.4"

[statics]
increments = 5
tolerance = 1e-8
newton = "mixed"
max_iterations = 50

[plot]
slope = 65.1
"#;

/// One mistake: `from` (once in the good scene) becomes `to`; the message must name the line on which
/// `at` then stands, the key, and say `words`.
pub struct Mistake {
    pub from: &'static str,
    pub to: &'static str,
    pub at: &'static str,
    pub key: &'static str,
    pub words: &'static str,
}

const fn mistake(
    from: &'static str,
    to: &'static str,
    at: &'static str,
    key: &'static str,
    words: &'static str,
) -> Mistake {
    Mistake { from, to, at, key, words }
}

/// Keys that nobody knows, one in every table.
#[rustfmt::skip]
pub const TYPOS: &[Mistake] = &[
    mistake("title =", "titel =", "titel", "titel", "did you mean `title`"),
    mistake("[plot]", "[plott]", "[plott]", "plott", "did you mean `plot`"),
    mistake("[[probe]]\nname = \"tip\"", "[[prob]]\nname = \"tip\"", "[[prob]]", "prob", "`probe`"),
    mistake("elements = 8", "elemnts = 8", "elemnts", "rod.0.elemnts", "did you mean `elements`"),
    mistake("coils = 2", "coil = 2", "coil = 2", "rod.0.curve.coil", "did you mean `coils`"),
    mistake("phase = 0.0", "fase = 0.0", "fase", "rod.0.curve.fase", "`origin` or `orientation`"),
    mistake("{ kind = \"helix\"", "{ kin = \"helix\"", "kin =", "rod.0.curve.kin", "did you mean `kind`"),
    mistake("from = [1", "form = [1", "form", "rod.1.curve.form", "did you mean `from`"),
    mistake(" diameter", " diametre", "diametre", "rod.0.section.diametre", "did you mean `diameter`"),
    mistake("kind = \"circle\"", "kimd = \"circle\"", "kimd", "rod.0.section.kimd", "`kind`"),
    mistake("shear_z", "shear_x", "shear_x", "rod.1.section.shear_x", "did you mean `shear_y`"),
    mistake("poisson_ratio", "poissons_ratio", "poissons", "rod.0.material.poissons_ratio", "did you mean `poisson_ratio`"),
    mistake("samples", "sample", "sample", "rod.0.reference.sample", "did you mean `samples`"),
    mistake("\"fit\", samples", "\"nodes\", samples", "samples", "rod.0.reference.samples", "`kind`"),
    mistake("axis =", "axes =", "axes", "joint.1.axes", "did you mean `axis`"),
    mistake("basis =", "bassis =", "bassis", "load.0.bassis", "did you mean `basis`"),
    mistake("angles =", "angels =", "angels", "probe.0.angels", "did you mean `angles`"),
    mistake("newton =", "newtom =", "newtom", "statics.newtom", "did you mean `newton`"),
    mistake("slope =", "slop =", "slop =", "plot.slop", "did you mean `slope`"),
];

/// What is no TOML, of the wrong type or not there.
#[rustfmt::skip]
pub const FORMS: &[Mistake] = &[
    mistake("elements = 8", "elements = ", "elements = \n", "elements =", "expected"),
    mistake("degree = 2", "degree = 2\ndegree = 2", "degree = 2\ninter", "degree = 2", "only once"),
    mistake("[statics]", "[statics", "[statics\n", "[statics", "`]`"),
    mistake("title = \"all tables\"", "title = all", "title", "title = all", "expected"),
    mistake("title = \"all tables\"", "title = 3", "title", "title", "a string"),
    mistake("-9.81]", "-9.81, 0]", "gravity", "gravity", "`[x, y, z]`"),
    mistake("-9.81]", "\"down\"]", "gravity", "gravity.2", "a number"),
    mistake("elements = 8", "elements = 8.5", "elements = 8.5", "rod.0.elements", "a whole number"),
    mistake("elements = 8", "elements = -8", "elements = -8", "rod.0.elements", "a whole number"),
    mistake("elements = 8", "elements = \"8\"", "elements = \"8\"", "rod.0.elements", "a whole number"),
    mistake("elements = 8\n", "", "[[rod]]\nname = \"spring\"", "rod.0.elements", "is missing"),
    mistake("elements = 3\n", "", "[[rod]]\nname = \"beam\"", "rod.1.elements", "is missing"),
    mistake("name = \"spring\"\n", "", "[[rod]]\ncurve", "rod.0.name", "a string"),
    mistake("radius = 10e-3, ", "", "curve", "rod.0.curve.radius", "a positive radius"),
    mistake("radius = 10e-3", "radius = \"10 mm\"", "curve", "rod.0.curve.radius", "a positive radius"),
    mistake("to = [1, 0, 1]", "to = [1, 0]", "to = [", "rod.1.curve.to", "`[x, y, z]`"),
    mistake("kind = \"line\"", "kind = \"lime\"", "lime", "rod.1.curve.kind", "did you mean \"line\""),
    mistake("\"circle\"", "\"ellipse\"", "ellipse", "rod.0.section.kind", "\"rectangle\" or \"custom\""),
    mistake(" diameter = 1e-3", " diameter = true", "diameter", "rod.0.section.diameter", "a positive diameter"),
    mistake(" diameter = 1e-3,", "", "section", "rod.0.section.diameter", "a positive diameter"),
    mistake("axial = 1e3", "axial = \"stiff\"", "axial", "rod.1.section.axial", "[N]"),
    mistake("axial = 1e3\n", "", "[rod.section]", "rod.1.section.axial", "[N]"),
    mistake("{ kind = \"circle\", diameter = 1e-3, inner_diameter = 1e-4 }", "\"circle\"", "section", "rod.0.section", "a table"),
    mistake("interpolation = \"r12\"", "interpolation = \"r21\"", "r21", "rod.0.interpolation", "\"r12\""),
    mistake("interpolation = \"r12\"", "interpolation = 12", "interpolation", "rod.0.interpolation", "\"r12\""),
    mistake("\"reduced\"", "\"half\"", "half", "rod.0.quadrature", "\"reduced\" or \"full\""),
    mistake("node_spacing = \"equal\"", "node_spacing = \"even\"", "even", "rod.0.node_spacing", "\"gauss-lobatto\" or \"equal\""),
    mistake("gravity = false", "gravity = 0", "gravity = 0\n", "rod.1.gravity", "true or false"),
    mistake("kind = \"rigid\"", "kind = \"glued\"", "glued", "joint.0.kind", "\"spherical\" or \"revolute\""),
    mistake("kind = \"rigid\"\n", "", "[[joint]]\nname = \"clamp\"", "joint.0.kind", "\"rigid\""),
    mistake("[\"ground\", \"spring@0\"]", "[\"spring@0\"]", "between = [\"spring@0\"]", "joint.0.between", "two parts"),
    mistake("[\"ground\", \"spring@0\"]", "\"spring@0\"", "between = \"spring@0\"", "joint.0.between", "two parts"),
    mistake("value = [0, 0, 0.01]", "value = 0.01", "value = 0.01", "load.0.value", "`[x, y, z]`"),
    mistake("value = [0, 0, 0.01]\n", "", "[[load]]\nkind = \"force\"", "load.0.value", "`[x, y, z]`"),
    mistake("\"line_moment\"", "\"couple\"", "couple", "load.1.kind", "\"line_moment\""),
    mistake("time = \"ramp\"", "time = \"rampp\"", "rampp", "load.1.time", "\"ramp\""),
    mistake("    [0.5, 1.0],", "    [0.5],", "time = [", "load.0.time", "[[t, factor], …]"),
    mistake("\"zyx\"", "\"xyz\"", "xyz", "probe.0.angles", "\"zyx\""),
    mistake("increments = 5", "increments = 5.0", "increments", "statics.increments", "a whole number"),
    mistake("newton = \"mixed\"", "newton = \"mixd\"", "mixd", "statics.newton", "did you mean \"mixed\""),
    mistake("slope = 65.1", "slope = \"65.1\"", "slope", "plot.slope", "a number"),
    mistake("[statics]", "[[statics]]", "[[statics]]", "statics", "a table"),
    mistake("[plot]", "[[plot]]", "[[plot]]", "plot", "a table `[plot]`"),
    mistake("material = { young_modulus = 1e11, poisson_ratio = 0.2, density = 7850 }", "material = [1e11, 4e10]", "material", "rod.0.material", "a table"),
    mistake("[[joint]]\nname = \"clamp\"", "[joint]\nname = \"clamp\"", "[[joint]]\nkind", "[[joint]]", "only once"),
    mistake("-9.81", "-inf", "gravity", "gravity.2", "a finite number"),
    mistake("    [0.5, 1.0],", "    [0.5, nan],", "0.5, nan", "load.0.time.1.1", "a finite number"),
    mistake("1e-8", "1e-8\ncoordinates = 3", "coordinates", "statics.coordinates", "\"quaternions\""),
    mistake("radius = 10e-3", "radius = inf", "radius", "rod.0.curve.radius", "a finite number"),
    mistake("axial = 1e3", "axial = 1e999", "axial", "axial = 1e999", "within range"),
];

/// Values and combinations that are impossible.
#[rustfmt::skip]
pub const VALUES: &[Mistake] = &[
    mistake("elements = 8", "elements = 0", "elements = 0", "rod.0.elements", "at least 1"),
    mistake("elements = 8", "elements = 1000000000000", "elements = 1", "rod.0.elements", "at most"),
    mistake("degree = 2", "degree = 0", "degree = 0", "rod.0.degree", "from 1 to 8"),
    mistake("degree = 2", "degree = 9", "degree = 9", "rod.0.degree", "from 1 to 8"),
    mistake("\"r12\"", "\"se3\"", "se3", "rod.0.interpolation", "degree 1"),
    mistake("samples = 60", "samples = 16", "samples", "rod.0.reference.samples", "at least 17 samples"),
    mistake("coils = 2", "coils = 0", "coils", "rod.0.curve.coils", "a positive number of coils"),
    mistake("radius = 10e-3", "radius = -10e-3", "radius", "rod.0.curve.radius", "a positive radius"),
    mistake("phase = 0.0", "orientation = [0, 0, 0, 0]", "curve", "rod.0.curve.orientation", "a quaternion other than zero"),
    mistake("kind = \"helix\", coils = 2, radius = 10e-3, pitch = 5e-3, phase = 0.0", "kind = \"arc\", radius = 0, angle = 1", "curve", "rod.0.curve.radius", "a positive radius"),
    mistake("kind = \"helix\", coils = 2, radius = 10e-3, pitch = 5e-3, phase = 0.0", "kind = \"arc\", radius = 1, angle = 0", "curve", "rod.0.curve.angle", "a positive angle"),
    mistake("kind = \"helix\", coils = 2, radius = 10e-3, pitch = 5e-3, phase = 0.0", "kind = \"line\", length = 0", "curve", "rod.0.curve.length", "a positive length"),
    mistake("kind = \"helix\", coils = 2, radius = 10e-3, pitch = 5e-3, phase = 0.0", "kind = \"poses\", file = \"a.csv\"", "reference", "rod.0.reference", "no `reference`"),
    mistake("kind = \"helix\", coils = 2, radius = 10e-3, pitch = 5e-3, phase = 0.0", "kind = \"poses\", file = \"\"", "file", "rod.0.curve.file", "CSV"),
    mistake("to = [1, 0, 1]", "to = [1, 0, 0]", "to = [1, 0, 0]", "rod.1.curve.to", "differs from the start"),
    mistake("to = [1, 0, 1]\n", "", "[rod.curve]", "rod.1.curve.to", "is missing"),
    mistake("from = [1, 0, 0]\n", "", "[rod.curve]", "rod.1.curve.from", "is missing"),
    mistake("from = [1, 0, 0]\nto = [1, 0, 1]\nnormal = [0, 1, 0]\n", "", "[rod.curve]", "rod.1.curve", "neither `length`"),
    mistake("from = [1, 0, 0]\nto = [1, 0, 1]\n", "length = 1\n", "normal", "rod.1.curve.normal", "beside `from` and `to`"),
    mistake("from = [1, 0, 0]\n", "from = [1, 0, 0]\nlength = 1\n", "length = 1", "rod.1.curve.length", "either `length`"),
    mistake("normal = [0, 1, 0]", "normal = [0, 0, -2]", "normal", "rod.1.curve.normal", "across the line"),
    mistake("normal = [0, 1, 0]", "normal = [0, 0, 0]", "normal", "rod.1.curve.normal", "other than zero"),
    mistake(" diameter = 1e-3", " diameter = -1e-3", "section", "rod.0.section.diameter", "is -0.001; expected a positive diameter"),
    mistake("inner_diameter = 1e-4", "inner_diameter = 1e-3", "section", "rod.0.section.inner_diameter", "below the diameter"),
    mistake("inner_diameter = 1e-4", "shear_factor = 0", "section", "rod.0.section.shear_factor", "a positive shear factor"),
    mistake("inner_diameter = 1e-4", "torsion_constant = 0", "section", "rod.0.section.torsion_constant", "a positive torsion constant"),
    mistake("\"circle\", diameter = 1e-3, inner_diameter = 1e-4", "\"rectangle\", width = 0, height = 1", "section", "rod.0.section.width", "a positive width"),
    mistake("\"circle\", diameter = 1e-3, inner_diameter = 1e-4", "\"rectangle\", width = 1, height = -1", "section", "rod.0.section.height", "a positive height"),
    mistake("shear_y = 2e3", "shear_y = 0", "shear_y", "rod.1.section.shear_y", "a positive stiffness [N]"),
    mistake("bending_z = 0.3", "bending_z = -0.3", "bending_z", "rod.1.section.bending_z", "[N m²]"),
    mistake("mass_per_length = 0.5", "mass_per_length = 0", "mass_per_length", "rod.1.section.mass_per_length", "[kg/m]"),
    mistake("2e-6, 3e-6]", "-2e-6, 3e-6]", "rotary_inertia", "rod.1.section.rotary_inertia.1", "[kg m]"),
    mistake("degree = 1\n", "degree = 1\nmaterial = { young_modulus = 1, poisson_ratio = 0 }\n", "material = { young_modulus = 1,", "rod.1.material", "no material"),
    mistake("material = {", "# material = {", "[[rod]]\nname = \"spring\"", "rod.0.material", "is missing"),
    mistake("young_modulus = 1e11, ", "", "material", "rod.0.material", "exactly two of"),
    mistake("young_modulus = 1e11", "young_modulus = 1e11, shear_modulus = 4e10", "material", "rod.0.material", "exactly two of"),
    mistake("young_modulus = 1e11", "young_modulus = 0", "material", "rod.0.material.young_modulus", "[Pa]"),
    mistake("poisson_ratio = 0.2", "poisson_ratio = 0.51", "material", "rod.0.material.poisson_ratio", "up to 0.5"),
    mistake("poisson_ratio = 0.2", "poisson_ratio = -1", "material", "rod.0.material.poisson_ratio", "above -1"),
    mistake("poisson_ratio = 0.2", "shear_modulus = 1e10", "material", "rod.0.material", "implies a Poisson's ratio of 4"),
    mistake("density = 7850", "density = -7850", "material", "rod.0.material.density", "[kg/m³]"),
    mistake(", density = 7850", "", "material", "rod.0.material.density", "takes part in gravity"),
    mistake("name = \"beam\"", "name = \"spring\"", "name = \"spring\"\nelements = 3", "rod.1.name", "a different name"),
    mistake("name = \"beam\"", "name = \"\"", "name = \"\"", "rod.1.name", "a name"),
    mistake("name = \"beam\"", "name = \"ground\"", "name = \"ground\"", "rod.1.name", "another name"),
    mistake("name = \"beam\"", "name = \"a@b\"", "a@b", "rod.1.name", "without @"),
    mistake("name = \"middle\"", "name = \"a,b\"", "a,b", "probe.1.name", "comma"),
    mistake("name = \"middle\"", "name = \"a/b\"", "a/b", "probe.1.name", "slash"),
    mistake("name = \"middle\"", "name = \"a\\tb\"", "a\\tb", "probe.1.name", "control characters"),
    mistake("name = \"middle\"", "name = \"tip\"", "name = \"tip\"\non = \"beam@0.4\"", "probe.1.name", "a different name"),
    mistake("name = \"clamp\"", "name = \"joint2\"", "[[joint]]\nkind = \"revolute\"", "joint.1.name", "a different name"),
    mistake("\"spring@0\"]", "\"sprung@0\"]", "sprung@0", "joint.0.between.1", "did you mean \"spring@0\""),
    mistake("\"spring@0\"]", "\"spring\"]", "\"spring\"]", "joint.0.between.1", "such as \"spring@1\""),
    mistake("[\"ground\", \"spring@0\"]", "[\"ground\", \"ground\"]", "\"ground\", \"ground\"", "joint.0.between", "\"rod@ξ\""),
    mistake("axis = [1, 0, 0]\n", "", "[[joint]]\nkind = \"revolute\"", "joint.1.axis", "is missing"),
    mistake("axis = [1, 0, 0]", "axis = [0, 0, 0]", "axis", "joint.1.axis", "other than zero"),
    mistake("kind = \"rigid\"", "kind = \"rigid\"\naxis = [1, 0, 0]", "axis = [1, 0, 0]\nbetween", "joint.0.axis", "revolute joints only"),
    mistake("on = \"spring@1\"\nvalue", "on = \"spring\"\nvalue", "on = \"spring\"", "load.0.on", "such as \"spring@1\""),
    mistake("on = \"spring@1\"\nvalue", "on = \"spring@x\"\nvalue", "spring@x", "load.0.on", "ξ from 0 to 1"),
    mistake("on = \"spring@1\"\nvalue", "on = \"spring@1.5\"\nvalue", "spring@1.5", "load.0.on", "ξ from 0 to 1"),
    mistake("on = \"spring@1\"\nvalue", "on = \"coil@1\"\nvalue", "coil@1", "load.0.on", "one of the rods"),
    mistake("on = \"beam\"", "on = \"beam@1\"", "on = \"beam@1\"", "load.1.on", "the rod's name alone"),
    mistake("on = \"beam\"", "on = \"beem\"", "beem", "load.1.on", "did you mean \"beam\""),
    mistake("kind = \"force\"", "kind = \"moment\"", "offset = [0, 1e-3", "load.0.offset", "\"force\""),
    mistake("    [0.5, 1.0],", "    [0.0, 1.0],", "    [0.0, 1.0]", "load.0.time.1.0", "increase"),
    mistake("time = \"ramp\"", "time = []", "time = []", "load.1.time", "at least one row"),
    mistake("on = \"beam@0.4\"", "on = \"beam@-0.1\"", "beam@-0.1", "probe.1.on", "ξ from 0 to 1"),
    mistake("on = \"beam@0.4\"", "on = \"been@0.4\"", "been@0.4", "probe.1.on", "did you mean \"beam@0.4\""),
    mistake("increments = 5", "increments = 0", "increments", "statics.increments", "at least 1"),
    mistake("tolerance = 1e-8", "tolerance = 0", "tolerance", "statics.tolerance", "a positive tolerance"),
    mistake("max_iterations = 50", "max_iterations = 0", "max_iterations", "statics.max_iterations", "at least 1"),
    mistake("[statics]\nincrements = 5\ntolerance = 1e-8\nnewton = \"mixed\"\nmax_iterations = 50\n", "", "title", "statics", "[statics]"),
];

/// Lists of a study that make no sense.
#[rustfmt::skip]
pub const STUDY: &[Mistake] = &[
    mistake("[plot]", "[study]\ndegres = [1]\n[plot]", "degres", "study.degres", "did you mean `degree`"),
    mistake("[plot]", "[study]\ndegree = 2\n[plot]", "degree = 2\n[plot]", "study.degree", "a list of degrees"),
    mistake("[plot]", "[study]\ndegree = []\n[plot]", "degree = []", "study.degree", "at least one entry"),
    mistake("[plot]", "[study]\ndegree = [1, 9]\n[plot]", "degree = [1, 9]", "study.degree.1", "from 1 to 8"),
    mistake("[plot]", "[study]\ndegree = [1.5]\n[plot]", "degree = [1.5]", "study.degree.0", "a whole number"),
    mistake("[plot]", "[study]\ndegree = [2, 2]\n[plot]", "degree = [2, 2]", "study.degree.1", "only once"),
    mistake("[plot]", "[study]\nelements = [10, 0]\n[plot]", "elements = [10", "study.elements.1", "at least 1"),
    mistake("[plot]", "[study]\ninterpolation = [\"r13\"]\n[plot]", "interpolation = [", "study.interpolation.0", "did you mean \"r12\""),
    mistake("[plot]", "[study]\nincrements = [\"auto\"]\n[plot]", "increments = [", "study.increments.0", "or \"automatic\""),
    mistake("[plot]", "[study]\nincrements = [0]\n[plot]", "increments = [0]", "study.increments.0", "at least 1"),
    mistake("[plot]", "[study]\ntime_step = [0.1]\n[plot]", "time_step = [0.1]", "study.time_step", "beside `[dynamics]`"),
    mistake("[plot]", "[study]\ntolerance = [\"tight\"]\n[plot]", "tolerance = [\"", "study.tolerance.0", "or \"default\""),
    mistake("[plot]", "[study]\ntolerance = [-1.0]\n[plot]", "tolerance = [-1", "study.tolerance.0", "a positive tolerance"),
    mistake("[plot]", "[study]\naccuracies = [0.0]\n[plot]", "accuracies", "study.accuracies.0", "a positive accuracy"),
    mistake("title = \"all tables\"", "study = [1]\ntitle = \"all tables\"", "study = [1]", "study", "a table `[study]`"),
];

/// What scenes may say one day.
#[rustfmt::skip]
pub const UNAVAILABLE: &[Mistake] = &[
    mistake("\"r12\"", "\"quaternion\"", "quaternion", "rod.0.interpolation", "not available yet"),
    mistake("\"cosserat\"", "\"shear-rigid\"", "theory", "rod.0.theory", "not available yet"),
    mistake("\"cosserat\"", "\"inextensible\"", "theory", "rod.0.theory", "not available yet"),
];
