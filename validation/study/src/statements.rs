//! What the source says of its figure, as numbers of a set.

use std::f64::consts::PI;

use hydrostat::{Arm, Configuration, Material, Options, Profile, SolveError, Solver};

/// alpha(L) at the highest tension, deg (published).
pub const TIP_ANGLE: f64 = 72.25;
/// The stream of Fig. 1a, m/s (published), and a faster one (ours).
pub const SPEEDS: [f64; 2] = [0.5, 1.0];
/// Tensions of Fig. 1a over the highest: ours.
const LADDER: [f64; 5] = [0.125, 0.25, 0.5, 0.75, 1.0];
/// Tensions over the highest at which speeds are compared: ours. The last is that of the blue curve of Fig. 1c.
pub const COMPARED: [f64; 3] = [0.25, 0.5, 1.0];
/// Stations at which alpha(s) is looked at, evenly from base to tip.
const STATIONS: usize = 201;
/// Angles below this are not told apart, deg.
const TOLD_APART: f64 = 1e-3;
/// How near alpha(L) has to come to the published angle, deg.
const CLOSE: f64 = 1e-3;
/// The tension to begin with, over C2 times the area of the tip section.
const GENTLE: f64 = 0.02;
/// Most doublings from there.
const DOUBLINGS: usize = 24;

/// A statement of the source.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Statement {
    /// 1a: without tension alpha(L) = 0.
    StraightTip,
    /// 1a: alpha(L) is 72.25 deg at the highest tension.
    TipAngle,
    /// 1a: alpha(L) gradually rises with the tension.
    TipRises,
    /// 1a: the arm is deformed more at higher tension.
    DeformsMore,
    /// 1b: the arm is deformed less in a faster stream.
    DeformsLess,
    /// 1b: the section at the tip turns less in a faster stream.
    TipTurnsLess,
    /// 1c: alpha(s) grows along the arm.
    GrowsAlong,
    /// 1c: alpha(s) is locally smaller in a faster stream.
    LocallySmaller,
}

impl Statement {
    /// All of them, in the order in which they are asked.
    pub const ALL: [Self; 8] = [
        Self::StraightTip,
        Self::TipAngle,
        Self::TipRises,
        Self::DeformsMore,
        Self::DeformsLess,
        Self::TipTurnsLess,
        Self::GrowsAlong,
        Self::LocallySmaller,
    ];

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::StraightTip => "alpha(L) = 0 without tension",
            Self::TipAngle => "alpha(L) = 72.25 deg is reached",
            Self::TipRises => "alpha(L) rises with tension",
            Self::DeformsMore => "deformed more at higher tension",
            Self::DeformsLess => "deformed less in a faster stream",
            Self::TipTurnsLess => "alpha(L) smaller in a faster stream",
            Self::GrowsAlong => "alpha(s) grows along the arm",
            Self::LocallySmaller => "alpha(s) locally smaller in a faster stream",
        }
    }
}

/// Why alpha(L) is not 72.25 deg at any tension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Miss {
    /// The largest alpha(L) that was met, deg.
    pub angle: f64,
    /// The kind of the verdict that ended it, or `tension` where tensions were raised as far as they go.
    pub why: &'static str,
}

/// A set held against the statements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// The highest tension, N.
    pub tension: f64,
    /// By how much each statement holds, where it is asked at the highest tension alone: see [`Judged::margins`].
    at_highest: [f64; 8],
    /// The same where speeds are compared at a quarter and at half of it, too.
    everywhere: [f64; 8],
    /// How far the tip section is turned at the highest tension, deg.
    pub turned: f64,
    /// The least nu along the arm there.
    pub least_stretch: f64,
    /// The fold margin there.
    pub fold_margin: f64,
    /// Share of the length over which alpha(s) grows there, in the worse of the streams.
    pub growing: f64,
    /// Share of the stations at which alpha(s) is smaller in the faster stream there.
    pub smaller: f64,
}

impl Judged {
    /// By how much each statement holds, negative where it fails, in the order of [`Statement::ALL`]: angles in deg, but
    /// deformation over L or in rad, and the growth of alpha(s) over alpha(L) a length. `everywhere` asks where speeds
    /// are compared at a quarter and at half of the highest tension, too.
    pub fn margins(&self, everywhere: bool) -> &[f64; 8] {
        if everywhere { &self.everywhere } else { &self.at_highest }
    }

    /// The statements that fail.
    pub fn failing(&self, everywhere: bool) -> Vec<Statement> {
        let margins = self.margins(everywhere).iter();
        Statement::ALL.into_iter().zip(margins).filter(|(_, margin)| **margin <= 0.0).map(|(s, _)| s).collect()
    }

    /// How far it is from satisfying all statements with a surface that does not fold: 0 or less where it does, by the least margin.
    pub fn shortfall(&self, everywhere: bool) -> f64 {
        let bounded = |margin: &f64| margin.clamp(-10.0, 10.0);
        let all = self.margins(everywhere).iter().chain(std::iter::once(&self.fold_margin));
        let missing: f64 = all.map(bounded).filter(|m| *m <= 0.0).map(|m| 1e-3 - m).sum();
        if missing > 0.0 {
            return missing;
        }
        // What is met or not met has no room.
        let with_room = &self.margins(everywhere)[Statement::TipRises as usize..];
        -with_room.iter().map(bounded).fold(self.fold_margin, f64::min)
    }
}

/// Holds all statements against an arm, of which the first cable is pulled and the others are slack, to a tip error of `tol` over
/// the length. What its tensions, their limits and its stream's speed are does not matter.
///
/// # Errors
/// [`Miss`] where the published angle is not reached, or one of the shapes that are compared does not exist.
pub fn judge(arm: &Arm, tol: f64) -> Result<Judged, Miss> {
    let bench = Bench { arm, tol };
    let highest = bench.highest()?;
    let tension = highest.arm.cables[0].tension;
    let at = |share: f64, speed: f64| bench.solved(share * tension, speed);

    let straight = at(0.0, SPEEDS[0])?;
    let mut ladder = vec![straight.clone()];
    for share in LADDER {
        ladder.push(if share == 1.0 { highest.clone() } else { at(share, SPEEDS[0])? });
    }
    let mut margins = [f64::INFINITY; 8];
    let mut note = |statement: Statement, margin: f64| {
        let own = &mut margins[statement as usize];
        *own = own.min(margin);
    };
    note(Statement::StraightTip, 1e-6 - tip_angle(&straight).abs());
    note(Statement::TipAngle, 2.0 * CLOSE - (tip_angle(&highest) - TIP_ANGLE).abs());
    for pair in ladder.windows(2) {
        note(Statement::TipRises, tip_angle(&pair[1]) - tip_angle(&pair[0]) - TOLD_APART);
        for (more, less) in deformation(&pair[1]).into_iter().zip(deformation(&pair[0])) {
            note(Statement::DeformsMore, more - less);
        }
    }
    let (mut at_highest, mut everywhere) = (margins, margins);
    let (mut growing, mut smaller) = (1.0_f64, 1.0);
    for share in COMPARED {
        let place = ladder.iter().position(|c| (c.arm.cables[0].tension / tension - share).abs() < 1e-9);
        let slow = place.map_or_else(|| at(share, SPEEDS[0]), |k| Ok(ladder[k].clone()))?;
        let fast = at(share, SPEEDS[1])?;
        let compared = compare(&slow, &fast);
        let angles = [&slow, &fast].map(alphas);
        if share == 1.0 {
            growing = angles.iter().map(|a| share_of(a.windows(2).map(|w| w[1] > w[0]))).fold(1.0, f64::min);
            smaller = share_of(angles[0].iter().zip(&angles[1]).map(|(slow, fast)| fast < slow));
        }
        for (statement, margin) in compared {
            let k = statement as usize;
            everywhere[k] = everywhere[k].min(margin);
            if share == 1.0 {
                at_highest[k] = at_highest[k].min(margin);
            }
        }
    }
    let least_stretch = highest.stations.nu.iter().copied().fold(f64::INFINITY, f64::min);
    Ok(Judged {
        tension,
        at_highest,
        everywhere,
        turned: highest.tip().theta.to_degrees(),
        least_stretch,
        fold_margin: highest.fold_margin().value,
        growing,
        smaller,
    })
}

/// By how much the statements hold that are about one tension in two streams.
pub fn compare(slow: &Configuration, fast: &Configuration) -> [(Statement, f64); 4] {
    let less = deformation(slow).into_iter().zip(deformation(fast)).map(|(slow, fast)| slow - fast);
    let angles = [slow, fast].map(alphas);
    let growth = |angles: &Vec<f64>| {
        let rise = angles.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        rise * (STATIONS - 1) as f64 / angles[STATIONS - 1]
    };
    let falls = angles[0].iter().zip(&angles[1]).map(|(slow, fast)| slow - fast);
    [
        (Statement::DeformsLess, less.fold(f64::INFINITY, f64::min)),
        (Statement::TipTurnsLess, tip_angle(slow) - tip_angle(fast) - TOLD_APART),
        (Statement::GrowsAlong, angles.iter().map(growth).fold(f64::INFINITY, f64::min)),
        (Statement::LocallySmaller, falls.fold(f64::INFINITY, f64::min) - TOLD_APART),
    ]
}

/// How far the tip is from its place in the straight arm (over L), and how far it is turned (rad).
fn deformation(c: &Configuration) -> [f64; 2] {
    let (tip, base, length) = (c.tip(), c.arm.base, c.arm.length);
    let (sin, cos) = base.angle.sin_cos();
    let moved = (tip.x - base.x - length * cos).hypot(tip.y - base.y - length * sin);
    [moved / length, (tip.theta - base.angle).abs()]
}

/// alpha(L), deg.
pub fn tip_angle(c: &Configuration) -> f64 {
    c.tip().alpha.to_degrees()
}

/// alpha(s) at even stations, deg.
pub fn alphas(c: &Configuration) -> Vec<f64> {
    (0..STATIONS).map(|k| c.at(c.arm.length * k as f64 / (STATIONS - 1) as f64).alpha.to_degrees()).collect()
}

/// C2 times the area of the tip section, N: what the tension at which that section shears compares with.
fn tip_shear_stiffness(arm: &Arm) -> f64 {
    let at_tip = |profile: &Profile| profile.at(arm.length, arm.length).value;
    let c2 = match &arm.material {
        Material::Coefficients { c2, .. } => at_tip(c2),
        Material::Homogeneous { young, poisson, shear_factor } => shear_factor * young / (2.0 * (1.0 + poisson)),
    };
    c2 * PI * at_tip(&arm.radius).powi(2)
}

fn share_of(flags: impl Iterator<Item = bool>) -> f64 {
    let (set, all) = flags.fold((0_u32, 0_u32), |(set, all), flag| (set + u32::from(flag), all + 1));
    f64::from(set) / f64::from(all.max(1))
}

/// Solves for an arm.
struct Bench<'a> {
    arm: &'a Arm,
    tol: f64,
}

impl Bench<'_> {
    fn solved(&self, tension: f64, speed: f64) -> Result<Configuration, Miss> {
        self.tried(tension, speed).map_err(|failed| failed.0)
    }

    /// The shape, or why there is none and the last one before that.
    fn tried(&self, tension: f64, speed: f64) -> Result<Configuration, Box<(Miss, Option<Configuration>)>> {
        let mut arm = self.arm.clone();
        arm.flow.speed = speed;
        for (k, cable) in arm.cables.iter_mut().enumerate() {
            cable.tension = if k == 0 { tension } else { 0.0 };
            // The statements are asked wherever the tension leads.
            cable.max_tension = None;
        }
        let found = Solver::new(&arm, Options::with_tol(self.tol)).and_then(|mut s| s.solve());
        found.map_err(|error| match error {
            SolveError::NoEquilibrium(no) => {
                let angle = no.last_good.as_ref().map_or(0.0, tip_angle);
                Box::new((Miss { angle, why: no.verdict.kind.name() }, no.last_good))
            }
            SolveError::Arm(_) | SolveError::Option { .. } => Box::new((Miss { angle: 0.0, why: "no_arm" }, None)),
        })
    }

    /// The shape at the first tension, raised in steps from a gentle one, at which alpha(L) is the published angle.
    fn highest(&self) -> Result<Configuration, Miss> {
        let mut low = (0.0, -TIP_ANGLE);
        let mut found = None;
        let mut tension = GENTLE * tip_shear_stiffness(self.arm);
        for _ in 0..DOUBLINGS {
            let (shape, miss) = match self.tried(tension, SPEEDS[0]) {
                Ok(shape) => (Some(shape), None),
                Err(failed) => {
                    let (miss, last) = *failed;
                    (last, Some(miss))
                }
            };
            // Where the tension has no shape, the one just below its limit may be turned far enough.
            if let Some(shape) = shape {
                let over = tip_angle(&shape) - TIP_ANGLE;
                let own = shape.arm.cables[0].tension;
                if over >= 0.0 && own > low.0 {
                    found = Some((shape, own, over));
                    break;
                }
                low = (own, over);
            }
            if let Some(miss) = miss {
                return Err(Miss { angle: miss.angle.max(low.1 + TIP_ANGLE), ..miss });
            }
            tension *= 2.0;
        }
        let Some((mut shape, own, over)) = found else {
            return Err(Miss { angle: low.1 + TIP_ANGLE, why: "tension" });
        };
        let mut high = (own, over);
        // Regula falsi with the Illinois weight.
        let mut side = 0;
        for _ in 0..40 {
            if (tip_angle(&shape) - TIP_ANGLE).abs() <= CLOSE {
                return Ok(shape);
            }
            let next = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            shape = self.solved(next, SPEEDS[0])?;
            let over = tip_angle(&shape) - TIP_ANGLE;
            let own_side = if over < 0.0 { -1 } else { 1 };
            let weight = if side == own_side { 0.5 } else { 1.0 };
            if over < 0.0 {
                low = (next, over);
                high.1 *= weight;
            } else {
                high = (next, over);
                low.1 *= weight;
            }
            side = own_side;
        }
        Err(Miss { angle: tip_angle(&shape), why: "unsteady" })
    }
}
