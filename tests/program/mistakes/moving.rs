//! Mistakes in scenes with bodies, multiplied joints, dynamics and modes.

use super::{Mistake, mistake};

/// A scene of parts that move; the cases below each spoil one place.
pub const MOVING: &str = r#"title = "parts that move"
gravity = [0.0, 0.0, -9.81]

[[rod]]
name = "wire"
curve = { kind = "line", length = 1.0 }
section = { kind = "circle", diameter = 1e-2 }
material = { young_modulus = 1e9, poisson_ratio = 0.3, density = 1200 }
elements = 4
degree = 2
inertia = true

[[rod]]
name = "strip"
curve = { kind = "line", from = [1, 0, 0], to = [2, 0, 0] }
elements = 4
degree = 2
gravity = false
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

[[body]]
name = "bob"
shape = { kind = "cylinder", radius = 0.02, height = 0.04 }
density = 7850
position = [2, 0, 0]
orientation = [1, 0, 0, 0]

[[body]]
name = "plate"
mass = 2.0
inertia = [1.0, 2.0, 3.0]
position = [0, 0, 1]
velocity = [0, 0, 1]
angular_velocity = [0.1, 0, 0]

[[body]]
name = "crate"
density = 1000
position = [0, 1, 0]
[body.shape]
kind = "cuboid"
size = [0.1, 0.2, 0.3]

[[joint]]
name = "clamp"
kind = "rigid"
between = ["ground", "wire@0"]

[[joint]]
kind = "spherical"
between = ["wire@1", "strip@0"]

[[joint]]
name = "grip"
kind = "rigid"
between = ["strip@1", "bob"]
point = [2, 0, 0]

[[joint]]
kind = "revolute"
between = ["crate", "ground"]
axis = [0, 0, 1]

[[load]]
kind = "force"
on = "plate"
value = [0, 0, 20]
basis = "body"
offset = [0.1, 0, 0]
time = [[0, 0], [0.5, 1]]

[[load]]
kind = "line_force"
on = "wire"
value = [0, 1, 0]
time = "constant"

[[probe]]
name = "swing"
on = "bob"
offset = [0, 0, 0.02]
angles = "zyx"

[[probe]]
name = "middle"
on = "wire@0.4"

[dynamics]
end_time = 2.0
time_step = 1e-2
method = "generalized-alpha"
spectral_radius = 0.8
tolerance = 1e-8
newton = "mixed"
max_iterations = 20
"#;

/// What is no key, of the wrong type or not there.
#[rustfmt::skip]
pub const FORMS: &[Mistake] = &[
    mistake("[[body]]\nname = \"crate\"", "[[boddy]]\nname = \"crate\"", "[[boddy]]", "boddy", "did you mean `body`"),
    mistake("[dynamics]", "[dynamic]", "[dynamic]", "dynamic", "did you mean `dynamics`"),
    mistake("density = 7850", "densty = 7850", "densty", "body.0.densty", "did you mean `density`"),
    mistake("height = 0.04", "heigth = 0.04", "shape", "body.0.shape.heigth", "did you mean `height`"),
    mistake("size = [", "sizes = [", "sizes", "body.2.shape.sizes", "did you mean `size`"),
    mistake("kind = \"cylinder\"", "kid = \"cylinder\"", "shape", "body.0.shape.kid", "did you mean `kind`"),
    mistake("mass = 2.0", "kind = \"sphere\"", "kind = \"sphere\"", "body.1.kind", "expected `name`, `shape`"),
    mistake("velocity = [0, 0, 1]", "veloctiy = [0, 0, 1]", "veloctiy", "body.1.veloctiy", "did you mean `velocity`"),
    mistake("end_time = 2.0", "endtime = 2.0", "endtime", "dynamics.endtime", "did you mean `end_time`"),
    mistake("spectral_radius", "spectral_radios", "spectral_radios", "dynamics.spectral_radios", "did you mean `spectral_radius`"),
    mistake("\"cylinder\"", "\"cilinder\"", "shape", "body.0.shape.kind", "did you mean \"cylinder\""),
    mistake("\"cuboid\"", "\"cube\"", "kind = \"cube\"", "body.2.shape.kind", "\"cuboid\" or \"sphere\""),
    mistake("\"cuboid\"", "3", "kind = 3", "body.2.shape.kind", "\"cuboid\" or \"sphere\""),
    mistake("shape = { kind = \"cylinder\", radius = 0.02, height = 0.04 }", "shape = \"cylinder\"", "shape", "body.0.shape", "a table such as"),
    mistake("shape = { kind = \"cylinder\", radius = 0.02, height = 0.04 }", "shape = [0.02, 0.04]", "shape", "body.0.shape", "a table such as"),
    mistake(", height = 0.04", "", "shape", "body.0.shape.height", "is missing"),
    mistake("height = 0.04", "height = \"4 cm\"", "shape", "body.0.shape.height", "a positive length [m]"),
    mistake("[0.1, 0.2, 0.3]", "0.1", "size = 0.1", "body.2.shape.size", "three positive edges"),
    mistake("inertia = [1.0, 2.0, 3.0]", "inertia = 1.0", "inertia = 1.0", "body.1.inertia", "three principal moments of inertia"),
    mistake("inertia = [1.0, 2.0, 3.0]", "inertia = true", "inertia = true\nposition", "body.1.inertia", "three principal moments of inertia"),
    mistake("mass = 2.0", "mass = \"2 kg\"", "mass = \"2", "body.1.mass", "a positive mass [kg]"),
    mistake("position = [2, 0, 0]\n", "", "[[body]]\nname = \"bob\"", "body.0.position", "the centre of mass"),
    mistake("name = \"bob\"\n", "", "[[body]]\nshape", "body.0.name", "a string"),
    mistake("angular_velocity = [0.1, 0, 0]", "angular_velocity = 0.1", "angular_velocity", "body.1.angular_velocity", "[rad/s]"),
    mistake("orientation = [1, 0, 0, 0]", "orientation = [0, 0, 0]", "orientation", "body.0.orientation", "a quaternion"),
    mistake("end_time = 2.0\n", "", "[dynamics]", "dynamics.end_time", "is missing; expected a positive time [s]"),
    mistake("time_step = 1e-2\n", "", "[dynamics]", "dynamics.time_step", "is missing, and so is `accuracy`; expected either a positive time step [s], or `accuracy`"),
    mistake("end_time = 2.0", "end_time = \"2 s\"", "end_time", "dynamics.end_time", "a positive time [s]"),
    mistake("\"generalized-alpha\"", "\"generalised-alpha\"", "method", "dynamics.method", "did you mean \"generalized-alpha\""),
    mistake("\"generalized-alpha\"", "\"rk4\"", "method", "dynamics.method", "\"generalized-alpha\" or \"radau\""),
    mistake("\"mixed\"", "\"full\"", "newton", "dynamics.newton", "\"mixed\" or \"displacement\""),
    mistake("max_iterations = 20", "max_iterations = 2.5", "max_iterations", "dynamics.max_iterations", "a whole number"),
    mistake("[dynamics]", "[[dynamics]]", "[[dynamics]]", "dynamics", "a table `[dynamics]`"),
    mistake(ANALYSIS, "[[modes]]\ncount = 3\n", "[[modes]]", "modes", "a table `[modes]`"),
    mistake(ANALYSIS, "[modes]\ncuont = 3\n", "cuont", "modes.cuont", "did you mean `count`"),
    mistake(ANALYSIS, "[modes]\n", "[modes]", "modes.count", "a whole number of modes, at least 1"),
    mistake(ANALYSIS, "[modes]\ncount = -3\n", "count", "modes.count", "a whole number"),
    mistake("velocity = [0, 0, 1]", "velocity = [0, 0, inf]", "velocity = [0, 0, inf]", "body.1.velocity.2", "a finite number"),
];

const ANALYSIS: &str = r#"[dynamics]
end_time = 2.0
time_step = 1e-2
method = "generalized-alpha"
spectral_radius = 0.8
tolerance = 1e-8
newton = "mixed"
max_iterations = 20
"#;

/// Bodies that cannot be.
#[rustfmt::skip]
pub const BODIES: &[Mistake] = &[
    mistake("name = \"bob\"", "name = \"plate\"", "name = \"plate\"\nmass", "body.1.name", "the name of `body.0` too"),
    mistake("name = \"bob\"", "name = \"wire\"", "name = \"wire\"\nshape", "body.0.name", "the name of `rod.0` too; expected a different name for every rod and body"),
    mistake("name = \"bob\"", "name = \"ground\"", "name = \"ground\"", "body.0.name", "what joints call the fixed world"),
    mistake("name = \"bob\"", "name = \"b@b\"", "name = \"b@b\"", "body.0.name", "without @"),
    mistake("name = \"bob\"", "name = \"\"", "name = \"\"", "body.0.name", "is empty"),
    mistake("density = 7850\n", "", "[[body]]\nname = \"bob\"", "body.0.density", "is missing beside `shape`"),
    mistake("shape = { kind = \"cylinder\", radius = 0.02, height = 0.04 }\n", "", "[[body]]\nname = \"bob\"", "body.0.shape", "is missing beside `density`"),
    mistake("mass = 2.0\n", "", "[[body]]\nname = \"plate\"", "body.1.mass", "is missing beside `inertia`"),
    mistake("inertia = [1.0, 2.0, 3.0]\n", "", "[[body]]\nname = \"plate\"", "body.1.inertia", "is missing beside `mass`"),
    mistake("mass = 2.0\ninertia = [1.0, 2.0, 3.0]\n", "", "[[body]]\nname = \"plate\"", "body.1", "gives no mass; expected either"),
    mistake("density = 7850", "mass = 0.4", "mass = 0.4", "body.0.mass", "is given together with `shape`; expected either `shape` and `density`"),
    mistake("density = 7850", "density = 7850\nmass = 0.4", "mass = 0.4", "body.0.mass", "is given together with `shape`"),
    mistake("density = 7850", "density = 7850\ninertia = [1, 1, 1]", "inertia = [1, 1, 1]", "body.0.inertia", "is given together with `shape`"),
    mistake("density = 7850", "density = 7850\nmass = 1\ninertia = [1, 1, 1]", "mass = 1\n", "body.0.mass", "is given together with `shape`"),
    mistake("mass = 2.0", "mass = 2.0\ndensity = 9", "density = 9", "body.1.density", "is given together with `mass`"),
    mistake("radius = 0.02", "radius = 0", "shape", "body.0.shape.radius", "a positive radius [m]"),
    mistake("height = 0.04", "height = -0.04", "shape", "body.0.shape.height", "is -0.04; expected a positive height [m]"),
    mistake("kind = \"cylinder\", radius = 0.02, height = 0.04", "kind = \"sphere\", radius = -1", "shape", "body.0.shape.radius", "a positive radius [m]"),
    mistake("[0.1, 0.2, 0.3]", "[0.1, 0, 0.3]", "size", "body.2.shape.size.1", "a positive edge [m]"),
    mistake("density = 7850", "density = 0", "density = 0", "body.0.density", "a positive density [kg/m³]"),
    mistake("mass = 2.0", "mass = -2.0", "mass = -2.0", "body.1.mass", "a positive mass [kg]"),
    mistake("inertia = [1.0, 2.0, 3.0]", "inertia = [1.0, 0, 3.0]", "inertia = [1.0, 0", "body.1.inertia.1", "a positive moment of inertia"),
    mistake("inertia = [1.0, 2.0, 3.0]", "inertia = [1.0, 2.0, 3.1]", "inertia = [1.0, 2.0, 3.1]", "body.1.inertia.2", "is 3.1, more than the other two together, 3, which no body has"),
    mistake("inertia = [1.0, 2.0, 3.0]", "inertia = [1e-3, 5e-4, 2e-4]", "inertia = [1e-3", "body.1.inertia.0", "at most their sum"),
    mistake("orientation = [1, 0, 0, 0]", "orientation = [0, 0, 0, 0]", "orientation", "body.0.orientation", "a quaternion other than zero"),
    mistake("radius = 0.02", "radius = 1e-200", "[[body]]\nname = \"bob\"", "body.0", "beyond all numbers"),
    mistake("radius = 0.02", "radius = 1e200", "[[body]]\nname = \"bob\"", "body.0", "products are positive and finite"),
    mistake("mass = 2.0", "mass = 1e-310", "[[body]]\nname = \"plate\"", "body.1", "of ordinary size"),
];

/// Joints, loads and probes that refer to the wrong thing.
#[rustfmt::skip]
pub const PARTS: &[Mistake] = &[
    mistake("\"strip@1\", \"bob\"", "\"strip@1\", \"bobb\"", "between = [\"strip@1\"", "joint.2.between.1", "is no body and no point of a rod (did you mean \"bob\"?)"),
    mistake("\"ground\", \"wire@0\"", "\"grund\", \"wire@0\"", "grund", "joint.0.between.0", "did you mean \"ground\""),
    mistake("\"strip@1\", \"bob\"", "\"strip@1\", \"bob@0.5\"", "between = [\"strip@1\"", "joint.2.between.1", "a body has no points; expected the name alone, \"bob\""),
    mistake("\"ground\", \"wire@0\"", "\"ground@0\", \"wire@0\"", "ground@0", "joint.0.between.0", "the ground has no points; expected the name alone"),
    mistake("\"wire@1\", \"strip@0\"", "\"wire\", \"strip@0\"", "between = [\"wire\"", "joint.1.between.0", "which is a rod and no point of it; expected a rod and ξ from 0 to 1, such as \"wire@1\""),
    mistake("\"wire@1\", \"strip@0\"", "\"wire@1\", \"stripe@0\"", "between = [\"wire@1\"", "joint.1.between.1", "did you mean \"strip@0\""),
    mistake("\"wire@1\", \"strip@0\"", "\"wire@1\", \"strip@2\"", "between = [\"wire@1\"", "joint.1.between.1", "beyond the ends"),
    mistake("\"wire@1\", \"strip@0\"", "\"wire@1\", \"strip@end\"", "between = [\"wire@1\"", "joint.1.between.1", "or one of the bodies \"bob\", \"plate\" or \"crate\", or \"ground\""),
    mistake("\"wire@1\", \"strip@0\"", "\"wire@1\", \"wire@1\"", "between = [\"wire@1\"", "joint.1.between", "joins a node of the rod \"wire\" to itself"),
    mistake("\"wire@1\", \"strip@0\"", "\"wire@1\", \"wire@0.9999999999\"", "between = [\"wire@1\"", "joint.1.between", "two different parts"),
    mistake("\"strip@1\", \"bob\"", "\"bob\", \"bob\"", "between = [\"bob\"", "joint.2.between", "joins the body \"bob\" to itself"),
    mistake("\"ground\", \"wire@0\"", "\"ground\", \"ground\"", "between = [\"ground\", \"ground\"", "joint.0.between", "the ground and a body or a point"),
    mistake("axis = [0, 0, 1]\n", "", "[[joint]]\nkind = \"revolute\"", "joint.3.axis", "is missing"),
    mistake("kind = \"spherical\"", "kind = \"spherical\"\naxis = [1, 0, 0]", "axis = [1", "joint.1.axis", "revolute joints only"),
    mistake("on = \"plate\"", "on = \"plate@1\"", "on = \"plate@1\"", "load.0.on", "a body has no points"),
    mistake("on = \"plate\"", "on = \"plat\"", "on = \"plat\"", "load.0.on", "did you mean \"plate\""),
    mistake("on = \"plate\"", "on = \"ground\"", "on = \"ground\"", "load.0.on", "which nothing moves"),
    mistake("on = \"plate\"", "on = \"strip\"", "on = \"strip\"", "load.0.on", "such as \"strip@1\", or one of the bodies"),
    mistake("kind = \"force\"", "kind = \"moment\"", "offset = [0.1", "load.0.offset", "\"force\" only"),
    mistake("kind = \"force\"", "kind = \"line_force\"", "on = \"plate\"", "load.0.on", "is the body \"plate\", but a line load acts along a rod"),
    mistake("on = \"wire\"", "on = \"wire@1\"", "on = \"wire@1\"", "load.1.on", "the rod's name alone, \"wire\""),
    mistake("on = \"bob\"", "on = \"bob@1\"", "on = \"bob@1\"", "probe.0.on", "the name alone, \"bob\""),
    mistake("on = \"bob\"", "on = \"Bob\"", "on = \"Bob\"", "probe.0.on", "did you mean \"bob\""),
    mistake("on = \"bob\"", "on = \"ground\"", "on = \"ground\"", "probe.0.on", "which nothing moves"),
    mistake("on = \"wire@0.4\"", "on = \"wire@1.4\"", "on = \"wire@1.4\"", "probe.1.on", "ξ from 0 to 1"),
];

/// Analyses that cannot be.
#[rustfmt::skip]
pub const ANALYSES: &[Mistake] = &[
    mistake(ANALYSIS, "", "title", "statics", "`[statics]`, which may be empty, `[dynamics]` and `[modes]`"),
    mistake("[dynamics]", "[statics]\n[dynamics]", "[dynamics]", "dynamics", "is given beside `[statics]`; expected only one of"),
    mistake("[dynamics]", "[modes]\ncount = 2\n[dynamics]", "[modes]", "modes", "is given beside `[dynamics]`"),
    mistake("[dynamics]", "[modes]\n[statics]\n[dynamics]", "[dynamics]", "dynamics", "is given beside `[statics]`"),
    mistake("end_time = 2.0", "end_time = 0", "end_time", "dynamics.end_time", "is 0; expected a positive time [s]"),
    mistake("time_step = 1e-2", "time_step = -1e-2", "time_step", "dynamics.time_step", "a positive time step [s]"),
    mistake("time_step = 1e-2", "time_step = 2.5", "time_step", "dynamics.time_step", "is 2.5, longer than the whole motion; expected at most the end time, 2 [s]"),
    mistake("time_step = 1e-2", "time_step = 1e-12", "time_step", "dynamics.time_step", "at most 10000000 steps"),
    mistake("tolerance = 1e-8", "tolerance = 0", "tolerance", "dynamics.tolerance", "a positive tolerance"),
    mistake("max_iterations = 20", "max_iterations = 0", "max_iterations", "dynamics.max_iterations", "at least 1"),
    mistake("spectral_radius = 0.8", "spectral_radius = 1.1", "spectral_radius", "dynamics.spectral_radius", "from 0 to 1"),
    mistake("spectral_radius = 0.8", "spectral_radius = -0.1", "spectral_radius", "dynamics.spectral_radius", "is -0.1; expected a spectral radius from 0 to 1"),
    mistake("spectral_radius = 0.8", "spectral_radius = 1", "spectral_radius", "dynamics.spectral_radius", "of joints such as \"joint2\""),
    mistake(ANALYSIS, "[modes]\ncount = 0\n", "count", "modes.count", "at least 1"),
    mistake(ANALYSIS, "[modes]\ncount = 100000000\n", "count", "modes.count", "at most 10000000 modes"),
    mistake(ANALYSIS, "[statics]\ncoordinates = \"quaternions\"\n", "coordinates", "statics.coordinates", "not available yet for bodies, such as \"bob\"; expected \"increments\""),
    mistake("time_step = 1e-2", "time_step = 1e-2\naccuracy = 1e-5", "accuracy", "dynamics.accuracy", "is given beside `time_step`; expected either a constant `time_step` [s], or the `accuracy`"),
    mistake("time_step = 1e-2", "accuracy = 0", "accuracy", "dynamics.accuracy", "is 0; expected a positive part of the rods' length, and angle [rad]"),
    mistake("time_step = 1e-2", "accuracy = -1e-5", "accuracy", "dynamics.accuracy", "expected a positive part"),
    mistake("time_step = 1e-2", "accuracy = nan", "accuracy", "dynamics.accuracy", "a finite number"),
    mistake("time_step = 1e-2", "accuracy = \"1e-5\"", "accuracy", "dynamics.accuracy", "expected a positive part"),
    mistake("time_step = 1e-2", "acuracy = 1e-5", "acuracy", "dynamics.acuracy", "did you mean `accuracy`"),
    mistake("time_step = 1e-2", "time_stp = 1e-2", "time_stp", "dynamics.time_stp", "did you mean `time_step`"),
    mistake(", density = 1200", "", "material", "rod.0.material.density", "but the rod has inertia in `[dynamics]` and takes part in gravity; expected the density [kg/m³], or `inertia = false` and `gravity = false` for this rod"),
    mistake("mass_per_length = 0.5\n", "", "[rod.section]", "rod.1.section.mass_per_length", "has inertia in `[dynamics]`; expected the mass per length [kg/m], or `inertia = false` for this rod"),
    mistake("rotary_inertia = [1e-6, 2e-6, 3e-6]\n", "", "[rod.section]", "rod.1.section.rotary_inertia", "or `inertia = false` for this rod"),
    mistake("inertia = true", "inertia = false\ngravity = true", "gravity = true", "rod.0.gravity", "no motion from the unstressed start; expected `gravity = false`"),
    mistake("inertia = true", "inertia = false\ngravity = false", "time = \"constant\"", "load.1.time", "expected a table that starts from 0"),
];
