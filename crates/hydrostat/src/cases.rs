//! Reference problems with exact answers: what tests, benchmarks and validation reports share.
//!
//! But for the cable problems (0.2 m, 100 kPa), all are uniform arms of length 1 m, bending stiffness
//! EI = 1 N m2 and volume law `none`, so that the numbers of the tables are the answers in m and
//! rad and the loads are the tables' load parameters.
//!
//! ```
//! let case = hydrostat::cases::end_moment_circle();
//! let solved = case.arm.solve().unwrap();
//! for quantity in &case.exact {
//!     assert!((quantity.what.of(&solved) - quantity.value).abs() < 1e-7);
//! }
//! ```

use std::f64::consts::{FRAC_PI_2, PI};

use crate::rod::arm::{Arm, Cable, Flow, FlowLaw, Gravity, Material};
use crate::rod::model_options::Volume;
use crate::statics::configuration::Configuration;

/// A problem and what its answer must be.
#[derive(Debug, Clone)]
pub struct Case {
    /// Name with its load parameter, unique among [`all`].
    pub name: String,
    /// The arm.
    pub arm: Arm,
    /// What is known of its configuration.
    pub exact: Vec<Quantity>,
    /// Where the numbers come from.
    pub source: &'static str,
}

/// One known number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Of what.
    pub what: Measure,
    /// Its value, in the unit of `what`.
    pub value: f64,
    /// How far the known value itself may be off, in the same unit: half a unit of the last digit
    /// that a table prints, or rounding. An answer has its own error on top of it.
    pub tolerance: f64,
}

/// What is read off a configuration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Measure {
    /// Place of the tip, m.
    TipX,
    /// Place of the tip, m.
    TipY,
    /// Rotation of the tip, rad.
    TipTheta,
    /// Stretch at half the length.
    MiddleNu,
    /// Shear strain at half the length.
    MiddleEta,
    /// Bending strain at half the length, 1/m.
    MiddleMu,
    /// Section stretch at half the length.
    MiddleBeta,
}

impl Measure {
    /// Its value in `configuration`.
    pub fn of(self, configuration: &Configuration) -> f64 {
        let middle = || configuration.at(0.5 * configuration.arm.length);
        match self {
            Self::TipX => configuration.tip().x,
            Self::TipY => configuration.tip().y,
            Self::TipTheta => configuration.tip().theta,
            Self::MiddleNu => middle().nu,
            Self::MiddleEta => middle().eta,
            Self::MiddleMu => middle().mu,
            Self::MiddleBeta => middle().beta,
        }
    }
}

const CLOSED_FORM: &str = "classical closed form";
const TABLES: &str = "published tables";

/// EA and GA (N) of the arms that stand for inextensible, unshearable ones. At the tables' largest
/// loads, 20 N and 100 N, the compliance left over moves a tip by less than the tables' last digit,
/// and a strain of that size still has digits of its own.
const RIGID: f64 = 1e12;

/// Radius of all arms here, m. Without water, cables and volume law it does not matter.
const RADIUS: f64 = 0.05;

/// A straight uniform arm of length 1 m along e1 with EI = 1 N m2, `none`, and the given axial and
/// shear stiffness (N), in still water without gravity.
pub fn uniform_arm(name: &str, ea: f64, ga: f64) -> Arm {
    let area = PI * RADIUS * RADIUS;
    let mut arm = Arm::cone(1.0, RADIUS, RADIUS, 1.0, 0.5);
    name.clone_into(&mut arm.name);
    arm.radius = RADIUS.into();
    arm.material = Material::Coefficients { c1: (ea / area).into(), c2: (ga / area).into(), c3: (1.0 / area).into() };
    arm.model.volume = Volume::None;
    arm
}

/// The arms that stand for inextensible, unshearable ones.
pub fn inextensible_arm(name: &str) -> Arm {
    uniform_arm(name, RIGID, RIGID)
}

fn exact<const K: usize>(values: [(Measure, f64, f64); K]) -> Vec<Quantity> {
    values.into_iter().map(|(what, value, tolerance)| Quantity { what, value, tolerance }).collect()
}

/// nu of a straight or circular arm whose cables pull with `fraction` = sum T / (C1 pi R^2):
/// the root below one of (1 - nu) beta(nu)^2 = fraction.
fn compressed(volume: Volume, fraction: f64) -> f64 {
    match volume {
        Volume::Planar => 2.0 / (1.0 + (1.0 + 4.0 * fraction).sqrt()),
        Volume::Circular => 1.0 / (1.0 + fraction),
        Volume::None => 1.0 - fraction,
    }
}

fn swollen(volume: Volume, nu: f64) -> f64 {
    match volume {
        Volume::Planar => 1.0 / nu,
        Volume::Circular => nu.powf(-0.5),
        Volume::None => 1.0,
    }
}

/// The uniform soft arm of the cable problems: 0.2 m long, radius 10 mm, 100 kPa.
fn cable_arm(name: &str, volume: Volume) -> Arm {
    let mut arm = Arm::cone(0.2, 0.01, 0.01, 100e3, 0.5);
    name.clone_into(&mut arm.name);
    arm.radius = 0.01.into();
    arm.model.volume = volume;
    arm
}

/// One cable at a constant offset of 5 mm, nothing else: a circular arc with
/// C1 (1 - nu) pi R^2 beta^2 = T and C3 mu pi R^2 beta = T y.
pub fn one_cable(volume: Volume, tension: f64) -> Case {
    let name = format!("one cable, {volume:?}, {tension} N");
    let mut arm = cable_arm(&name, volume);
    let offset = 0.005;
    arm.cables.push(Cable::new("left", offset).pulled(tension));
    let area = PI * 0.01 * 0.01;
    let nu = compressed(volume, tension / (100e3 * area));
    let beta = swollen(volume, nu);
    let c3 = 100e3 * 0.01 * 0.01 / 4.0;
    let mu = tension * offset / (c3 * area * beta);
    let angle = mu * arm.length;
    let exact = exact([
        (Measure::TipX, nu * angle.sin() / mu, 1e-15),
        (Measure::TipY, nu * (1.0 - angle.cos()) / mu, 1e-15),
        (Measure::TipTheta, angle, 1e-15),
        (Measure::MiddleNu, nu, 1e-15),
        (Measure::MiddleEta, 0.0, 1e-15),
        (Measure::MiddleMu, mu, 1e-14),
        (Measure::MiddleBeta, beta, 1e-15),
    ]);
    Case { name, arm, exact, source: CLOSED_FORM }
}

/// Two opposite cables at equal distance, pulled alike: a straight arm that carries their sum.
pub fn opposite_cables(volume: Volume, tension: f64) -> Case {
    let name = format!("opposite cables, {volume:?}, {tension} N each");
    let mut arm = cable_arm(&name, volume);
    arm.cables.push(Cable::new("left", 0.005).pulled(tension));
    arm.cables.push(Cable::new("right", -0.005).pulled(tension));
    let nu = compressed(volume, 2.0 * tension / (100e3 * PI * 0.01 * 0.01));
    let exact = exact([
        (Measure::TipX, nu * arm.length, 1e-15),
        (Measure::TipY, 0.0, 1e-15),
        (Measure::TipTheta, 0.0, 1e-15),
        (Measure::MiddleNu, nu, 1e-15),
        (Measure::MiddleEta, 0.0, 1e-15),
        (Measure::MiddleMu, 0.0, 1e-14),
        (Measure::MiddleBeta, swollen(volume, nu), 1e-15),
    ]);
    Case { name, arm, exact, source: CLOSED_FORM }
}

/// The end moment m L/EI = 2 pi, which closes the arm to a full circle.
pub fn end_moment_circle() -> Case {
    let name = "end moment, full circle".to_owned();
    let mut arm = uniform_arm(&name, 1e4, 1e4);
    arm.tip.moment = 2.0 * PI;
    let exact = exact([
        (Measure::TipX, 0.0, 1e-15),
        (Measure::TipY, 0.0, 1e-15),
        (Measure::TipTheta, 2.0 * PI, 1e-15),
        (Measure::MiddleNu, 1.0, 1e-15),
        (Measure::MiddleEta, 0.0, 1e-15),
        (Measure::MiddleMu, 2.0 * PI, 1e-14),
    ]);
    Case { name, arm, exact, source: CLOSED_FORM }
}

/// Inextensible elastica under a dead transverse end load P L^2/EI, for each load of the table.
pub fn end_loads() -> Vec<Case> {
    [
        (1.0, 0.301_720_773_8, 0.056_433_236_3, 0.461_351_949_7, 5e-11),
        (2.0, 0.493_457_480_4, 0.160_641_720_8, 0.781_749_831_6, 5e-11),
        (5.0, 0.713_791_523_6, 0.387_628_360_7, 1.215_368_118, 5e-10),
        (10.0, 0.810_609_024_9, 0.554_995_597_8, 1.430_285_539, 5e-10),
    ]
    .into_iter()
    .map(|(load, across, along, theta, last)| {
        let name = format!("elastica, dead end load {load}");
        let mut arm = inextensible_arm(&name);
        arm.tip.force = [0.0, load];
        let exact = exact([
            (Measure::TipX, 1.0 - along, 5e-11),
            (Measure::TipY, across, 5e-11),
            (Measure::TipTheta, theta, last),
        ]);
        Case { name, arm, exact, source: TABLES }
    })
    .collect()
}

/// Elastica with shear, inextensible, under the dead transverse end load P L^2/EI = 1, for each
/// GA L^2/EI of the table.
pub fn end_loads_with_shear() -> Vec<Case> {
    [(50.0, 0.061_315_658, 0.317_813_874), (5.0, 0.103_284_917, 0.465_413_303), (1.0, 0.252_136_606, 1.167_095_878)]
        .into_iter()
        .map(|(ga, along, across)| {
            let name = format!("elastica with shear, GA {ga}");
            let mut arm = uniform_arm(&name, RIGID, ga);
            arm.tip.force = [0.0, 1.0];
            let exact = exact([(Measure::TipX, 1.0 - along, 5e-10), (Measure::TipY, across, 5e-10)]);
            Case { name, arm, exact, source: TABLES }
        })
        .collect()
}

const DISTRIBUTED: [(f64, f64, f64, f64); 3] = [
    (1.0, 0.123_471_402, 0.008_753_605, 0.165_115_561),
    (10.0, 0.700_199_716, 0.343_646_239, 1.052_643_117),
    (100.0, 0.937_523_935, 0.840_776_617, 1.564_107_321),
];

fn distributed(name: String, arm: Arm, across: f64, along: f64, theta: f64) -> Case {
    let exact =
        exact([(Measure::TipX, 1.0 - along, 5e-10), (Measure::TipY, across, 5e-10), (Measure::TipTheta, theta, 5e-10)]);
    Case { name, arm, exact, source: TABLES }
}

/// Inextensible arm under a uniform dead transverse load w L^3/EI, for each load of the table.
pub fn distributed_loads() -> Vec<Case> {
    DISTRIBUTED
        .into_iter()
        .map(|(load, across, along, theta)| {
            let name = format!("uniform dead load {load}");
            let mut arm = inextensible_arm(&name);
            arm.distributed.force[1] = load.into();
            distributed(name, arm, across, along, theta)
        })
        .collect()
}

/// The same load as the arm's own weight in a vacuum, gravity pointing along e2.
pub fn own_weights() -> Vec<Case> {
    DISTRIBUTED
        .into_iter()
        .map(|(load, across, along, theta)| {
            let name = format!("own weight {load}");
            let mut arm = inextensible_arm(&name);
            weigh(&mut arm, load, FRAC_PI_2);
            distributed(name, arm, across, along, theta)
        })
        .collect()
}

/// Gives the arm the weight `load` (N/m) towards `direction`, in a vacuum.
fn weigh(arm: &mut Arm, load: f64, direction: f64) {
    let acceleration = 10.0;
    arm.density = load / (PI * RADIUS * RADIUS * acceleration);
    arm.flow.density = 0.0;
    arm.gravity = Some(Gravity { acceleration, direction });
}

/// Inextensible arm under an end force P L^2/EI that stays normal to the tip, for each load of the table.
pub fn follower_loads() -> Vec<Case> {
    [
        (1.0, 0.495_884_642, 0.935_645_669, 0.320_641_995),
        (10.0, 2.992_714_816, -0.092_123_181, 0.546_983_265),
        (20.0, 2.850_579_901, 0.275_710_123, 0.330_157_660),
    ]
    .into_iter()
    .map(|(load, theta, x, y)| {
        let name = format!("follower end force {load}");
        let mut arm = inextensible_arm(&name);
        arm.tip.follower = [0.0, load];
        let exact = exact([(Measure::TipX, x, 5e-10), (Measure::TipY, y, 5e-10), (Measure::TipTheta, theta, 5e-10)]);
        Case { name, arm, exact, source: TABLES }
    })
    .collect()
}

/// Inextensible arm clamped across a stream that loads it with quadratic normal drag alone, for
/// each Cauchy number Ca = 1/2 rho C_n D U^2 L^3/EI of the table.
pub fn normal_drag() -> Vec<Case> {
    [
        (1.0, 9.314_441, 0.121_533_31, 0.991_518_48),
        (10.0, 47.090_451, 0.568_294_53, 0.790_623_71),
        (100.0, 76.714_772, 0.824_167_34, 0.453_460_61),
    ]
    .into_iter()
    .map(|(ca, angle, deflection, height): (f64, f64, f64, f64)| {
        let name = format!("quadratic normal drag, Ca {ca}");
        let mut arm = inextensible_arm(&name);
        arm.base.angle = FRAC_PI_2;
        let (density, cn) = (1000.0, 1.2);
        let speed = (ca / (0.5 * density * cn * 2.0 * RADIUS)).sqrt();
        arm.flow = Flow { speed, density, law: FlowLaw::QuadraticDrag { cn, ct: 0.0 }, ..Flow::default() };
        let exact = exact([
            (Measure::TipX, deflection, 5e-9),
            (Measure::TipY, height, 5e-9),
            (Measure::TipTheta, FRAC_PI_2 - angle.to_radians(), 5e-7_f64.to_radians()),
        ]);
        Case { name, arm, exact, source: TABLES }
    })
    .collect()
}

/// Every problem of this module that has one known answer.
pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    for volume in [Volume::Planar, Volume::Circular, Volume::None] {
        for tension in [1.0, 4.0, 8.0] {
            cases.push(one_cable(volume, tension));
            cases.push(opposite_cables(volume, tension));
        }
    }
    cases.push(end_moment_circle());
    cases.extend(end_loads());
    cases.extend(end_loads_with_shear());
    cases.extend(distributed_loads());
    cases.extend(own_weights());
    cases.extend(follower_loads());
    cases.extend(normal_drag());
    cases
}

/// The least dead thrust (N) that buckles a straight clamped-free arm with EI = 1 N m2 and length
/// 1 m: P (1 + P (1/GA - 1/EA)) = pi^2 EI/(4 L^2). `None` when an arm so short and soft in tension
/// has no such load.
pub fn column_buckling_load(ea: f64, ga: f64) -> Option<f64> {
    let euler = PI * PI / 4.0;
    let k = 1.0 / ga - 1.0 / ea;
    let discriminant = 1.0 + 4.0 * k * euler;
    // The root that tends to Euler's load with k, in the form that does not cancel.
    (discriminant >= 0.0).then(|| 2.0 * euler / (1.0 + discriminant.sqrt()))
}

/// A straight arm along e1 under the thrust `load` (N) on its tip, and `across` (N) across it.
pub fn column(ea: f64, ga: f64, load: f64, across: f64) -> Arm {
    let mut arm = uniform_arm("column", ea, ga);
    arm.tip.force = [-load, across];
    arm
}

/// q L^3/EI of the heaviest inextensible column, clamped at its foot, that stands under its own weight.
pub const HEAVY_COLUMN: f64 = 7.837_347_44;

/// An upright inextensible arm of weight q L^3/EI = `load` in a vacuum, pushed by `across` (N) at its top.
pub fn heavy_column(load: f64, across: f64) -> Arm {
    let mut arm = inextensible_arm("heavy column");
    arm.base.angle = FRAC_PI_2;
    weigh(&mut arm, load, -FRAC_PI_2);
    arm.tip.force = [across, 0.0];
    arm
}
