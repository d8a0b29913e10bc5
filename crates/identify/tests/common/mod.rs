//! Arms with known parameters, and measurements of them with errors of a known size.

#![allow(dead_code, reason = "each test uses a part")]

use hydrostat::{Arm, Cable, FlowLaw, Gravity, Profile};
use hydrostat_identify::{Case, Measurement, Quantity, value_of};

/// Numbers that look random and are the same in every run (Steele, Lea and Flood 2014).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def0)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A whole number below `count`.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.next() % count as u64).unwrap()
    }

    /// With mean 0 and standard deviation 1 (Box and Muller 1958).
    pub(crate) fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.uniform(), self.uniform());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }
}

/// The silicone arm of `docs/model.md`, section 10, with its authors' drag.
pub(crate) fn silicone() -> Arm {
    let mut arm = Arm::cone(0.245, 0.010, 0.002, 110e3, 0.5);
    arm.density = 1080.0;
    arm.cables.push(Cable::new("left", Profile::linear(0.005, 0.001)));
    arm.cables.push(Cable::new("right", Profile::linear(-0.005, -0.001)));
    arm.flow.density = 1022.0;
    arm.flow.law = FlowLaw::QuadraticDrag { cn: 2.5, ct: 0.005 };
    arm
}

/// The silicone arm pulled in still water, across a stream, and hanging sideways in gravity.
pub(crate) fn loads() -> Vec<(String, Arm)> {
    let with = |name: &str, tensions: [f64; 2], speed: f64, weight: bool| {
        let mut arm = silicone();
        arm.cables[0].tension = tensions[0];
        arm.cables[1].tension = tensions[1];
        (arm.flow.speed, arm.flow.direction) = (speed, 1.2);
        arm.gravity = weight.then(Gravity::default);
        (name.to_owned(), arm)
    };
    vec![
        with("pulled", [0.25, 0.0], 0.0, false),
        with("stream", [0.0, 0.05], 0.12, false),
        with("faster", [0.1, 0.0], 0.2, false),
        with("weight", [0.05, 0.0], 0.0, true),
    ]
}

/// Positions at so many equally spaced markers.
pub(crate) fn markers(count: u32) -> Vec<Quantity> {
    let places = (1..=count).map(|k| 0.245 * f64::from(k) / f64::from(count));
    places.flat_map(|s| [Quantity::X(s), Quantity::Y(s)]).collect()
}

/// What these arms have of the quantities, without errors, with the standard deviation `sd` of each.
pub(crate) fn exact(arms: &[(String, Arm)], quantities: &[Quantity], sd: impl Fn(Quantity) -> f64) -> Vec<Case> {
    let one = |(name, arm): &(String, Arm)| {
        let shape = arm.solve().unwrap();
        let measurements =
            quantities.iter().map(|quantity| Measurement::new(*quantity, value_of(&shape, *quantity), sd(*quantity)));
        Case { name: name.clone(), arm: arm.clone(), measurements: measurements.collect() }
    };
    arms.iter().map(one).collect()
}

/// The same with errors of the standard deviations stated.
pub(crate) fn noisy(cases: &[Case], random: &mut Random) -> Vec<Case> {
    let mut out = cases.to_vec();
    for one in out.iter_mut().flat_map(|case| &mut case.measurements) {
        one.value += one.sd * random.normal();
    }
    out
}
