//! Whether an equilibrium is stable against static divergence, and in how many directions it is not.
//!
//! The tangent of an equilibrium is not symmetric: drag, loads that follow the arm and cables are no
//! gradients, and neither is the section law. What is unstable is then a matter of motion, not of an
//! energy, and the motion meant here is an overdamped one: a resistance to the velocity of the
//! centreline over L, and to the rate of turn, with the coefficient one for both,
//!
//! ```text
//! d (x, y, theta)/dt = K (x, y, theta)        K = -C^-1
//! ```
//!
//! in lengths of L and forces of C3 A0/L^2 at the base, where K is the net linearised force and couple
//! per length and C the compliance of `compliance`: base clamped, loads at the tip and along the
//! arm following as they do. A motion in proportion to exp(lambda t) has -C lambda u = u, so that each
//! eigenvalue kappa of C is a rate lambda = -1/kappa. Each rate with a positive real part is a direction in
//! which the arm leaves the equilibrium. Rates are given over the slowest decay of the same arm unloaded, which
//! drops the coefficients' unit.
//!
//! Where the strokes of cables are commanded, C is that of the arm with the lengths of the taut ones held (the last
//! part of `compliance`): their tensions change with a motion, slack ones stay slack.
//!
//! The number of real positive rates is even where the determinant of the equilibrium is positive and odd where it is
//! negative, whatever the metric; pairs of complex ones, which the metric does bear on, leave
//! it as it is. Flutter, which takes inertia, is out of reach: Beck's column flutters where the overdamped one
//! still creeps back.

use hydrostat_bvp::{Collocation, Correction, Determinant, Lanes, Solution};
use nalgebra::DMatrix;
use nalgebra::linalg::Schur;

use crate::rod::model_options::Support;
use crate::statics::border::{UnitPull, border};
use crate::statics::compliance::{Basis, Compliance, FIELDS, project};
use crate::statics::configuration::Configuration;
use crate::statics::dense::Dense;
use crate::statics::engine::{M, correct, linearise, pull_taut, response_change, turn_sections};
use crate::statics::equations::{Equations, L, N, Q, StationData, Way};
use crate::statics::verdict::Phase;

/// Rates whose real part is smaller, over the slowest decay of the unloaded arm, are neither growth nor decay.
///
/// Near a buckling load the scaled rate is about the fraction of the load that is missing or too much. A straight
/// column at its exact load comes out below 1e-9. Of a hundred random arms, most of them bent, the first rate moves by
/// up to 2e-6 of the larger of one and itself between solves to 1e-8 and to 1e-11, growing ones left out.
pub(crate) const MARGIN: f64 = 1e-6;

/// Rates this many times the smallest one are rounding: an eigenvalue of the compliance has no digit left there.
pub(crate) const ROUNDING: f64 = 1e12;

/// The same where lengths are held: what loads a cable alone could make moves nothing, which polynomials meet no better
/// than that, with eigenvalues of either sign.
pub(crate) const BLURRED: f64 = 1e6;

/// Most rates that are kept when fewer grow.
pub(crate) const KEPT: usize = 6;

/// Polynomials a field, and elements no longer than a part of the arm by as many; more where the count of what grows is
/// not settled.
const POLYNOMIALS: [usize; 3] = [16, 24, 36];

/// What becomes of an equilibrium after a small push, inertia aside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Stability {
    /// Every motion decays.
    Stable,
    /// Motions in so many independent directions grow. A pair of complex rates counts as two: such a motion
    /// grows as it swings, which an arm in a stream against it does, and depends on the resistance assumed.
    Unstable(usize),
    /// A motion neither grows nor decays within what can be told: the arm is at a buckling load.
    Marginal,
}

impl Stability {
    /// `Some` where it is established either way.
    pub fn is_stable(self) -> Option<bool> {
        match self {
            Self::Stable => Some(true),
            Self::Unstable(_) => Some(false),
            Self::Marginal => None,
        }
    }

    /// The name in results: `stable`, `unstable` or `marginal`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable(_) => "unstable",
            Self::Marginal => "marginal",
        }
    }

    /// In how many directions it is unstable; `None` at a buckling load.
    pub fn directions(self) -> Option<usize> {
        match self {
            Self::Stable => Some(0),
            Self::Unstable(count) => Some(count),
            Self::Marginal => None,
        }
    }
}

/// How fast small motions about an equilibrium grow or decay when they are overdamped.
#[derive(Debug, Clone, PartialEq)]
pub struct Growth {
    /// Real and imaginary part of the rates over the slowest decay of the unloaded arm, largest real part
    /// first: all that grow, and at least six where there are as many.
    pub rates: Vec<[f64; 2]>,
}

impl Growth {
    /// What the rates say.
    pub fn stability(&self) -> Stability {
        match growing(&self.rates) {
            0 if self.rates.first().is_some_and(|rate| rate[0] >= -MARGIN) => Stability::Marginal,
            0 => Stability::Stable,
            count => Stability::Unstable(count),
        }
    }

    /// Whether a motion may end here. With an odd number of growing motions the determinant is negative, and one of
    /// them grows against any resistance. An even number may all decay against that of the arm, which is not that
    /// assumed.
    pub(crate) fn lets_rest(&self) -> bool {
        match self.stability() {
            Stability::Stable => true,
            Stability::Unstable(count) => count.is_multiple_of(2),
            Stability::Marginal => false,
        }
    }
}

impl Configuration {
    /// Whether this equilibrium is stable against static divergence, see [`Configuration::growth`].
    /// `None` where that is not established.
    pub fn stability(&self) -> Option<Stability> {
        self.growth().map(|growth| growth.stability())
    }

    /// How fast small overdamped motions about this equilibrium grow or decay: of the velocity of the
    /// centreline over L and of the rate of turn, each against a resistance of one along the whole arm.
    ///
    /// Taut cables whose stroke is commanded hold their lengths, whichever way the arm moves.
    ///
    /// Computed when asked for, in two to three milliseconds. `None` with [`Support::UnstrainedBase`], whose arm is
    /// no equilibrium at the tip, with friction of cables, whose tensions would change along them as the arm moves, in
    /// a way that depends on which way each place slides, and where the number of growing motions does not settle as
    /// they are resolved more finely.
    pub fn growth(&self) -> Option<Growth> {
        growth(self.dense()).map(|(growth, _)| growth)
    }
}

/// How many of `rates` grow.
pub(crate) fn growing(rates: &[[f64; 2]]) -> usize {
    rates.iter().filter(|rate| rate[0] > MARGIN).count()
}

/// The growth, and how many times it was resolved more finely.
fn growth(dense: &Dense) -> Option<(Growth, usize)> {
    let arm = dense.equations.arm();
    if arm.model.support == Support::UnstrainedBase || arm.has_friction() {
        return None;
    }
    for (level, functions) in POLYNOMIALS.into_iter().enumerate() {
        let tangent = Tangent::new(dense, functions)?;
        let unit = tangent.slowest_decay(functions)?;
        let compliance = tangent.compliance(functions)?;
        let mut rates = scaled_rates(&compliance, functions, unit)?;
        let fewer = scaled_rates(&compliance, functions - functions / 4, unit)?;
        let count = growing(&rates);
        let marginal = rates.iter().any(|rate| rate[0].abs() <= MARGIN);
        if count == growing(&fewer) && (marginal || tangent.agrees_with(count)) {
            rates.truncate(count.max(KEPT));
            return Some((Growth { rates }, level));
        }
    }
    None
}

/// The rates -1/kappa of the first `functions` polynomials over `unit`, largest real part first.
fn scaled_rates(compliance: &Compliance, functions: usize, unit: f64) -> Option<Vec<[f64; 2]>> {
    let least = if compliance.at_strokes { BLURRED } else { ROUNDING };
    let size = FIELDS * functions;
    rates_of(DMatrix::from_fn(size, size, |i, j| compliance.entry(i, j)), unit, least)
}

/// The rates -1/kappa over `unit` of the eigenvalues kappa of a compliance, largest real part first, without those
/// `least` times the smallest.
pub(crate) fn rates_of(matrix: DMatrix<f64>, unit: f64, least: f64) -> Option<Vec<[f64; 2]>> {
    let size = matrix.nrows();
    if !matrix.iter().all(|v| v.is_finite()) {
        return None;
    }
    let eigenvalues = Schur::try_new(matrix, f64::EPSILON, 100 * size)?.complex_eigenvalues();
    let largest = eigenvalues.iter().map(|kappa| kappa.norm()).fold(0.0, f64::max);
    let mut rates: Vec<[f64; 2]> = eigenvalues
        .iter()
        .filter(|kappa| kappa.norm() * least > largest)
        .map(|kappa| {
            let factor = 1.0 / (unit * kappa.norm_sqr());
            [-kappa.re * factor, kappa.im * factor]
        })
        .collect();
    rates.sort_by(|a, b| b[0].total_cmp(&a[0]));
    Some(rates)
}

/// The linearised equations about a solution.
struct Tangent {
    equations: Equations,
    system: Collocation<N, M, Q, L>,
    solution: Solution<N, M, L>,
    determinant: Determinant,
}

impl Tangent {
    /// About the solution, on its own mesh with elements cut that are longer than a part `1 / parts` of the arm.
    fn new(dense: &Dense, parts: usize) -> Option<Self> {
        let mut this = Self {
            equations: dense.equations.clone(),
            system: Collocation::new(),
            solution: dense.solution.clone(),
            determinant: Determinant::ONE,
        };
        let mesh = dense.solution.mesh.cut_to(1.0 / parts as f64);
        if mesh != dense.solution.mesh {
            let mut cut = Solution { mesh, ..Solution::default() };
            let equations = &this.equations;
            this.solution.remap(&this.system.gauss, |s| equations.jumps_at(s), &mut cut);
            this.equations.place_on(&this.system.gauss, &cut);
            this.solution = cut;
            let mut correction = Correction::default();
            for _ in 0..2 {
                this.linearise()?;
                correct(&mut this.system, &this.solution, &mut correction);
                this.solution.add(&correction, 1.0);
            }
        }
        this.linearise()?;
        Some(this)
    }

    /// The slowest decay of the arm on the same mesh with no load at all: reference strains, nothing carried.
    fn slowest_decay(&self, functions: usize) -> Option<f64> {
        let mut equations = self.equations.clone();
        equations.let_go();
        equations.set_phase(Phase::Loads, 0.0);
        let system = Collocation::new();
        let base = [equations.arm().base.angle, 0.0, 0.0, 0.0];
        let mut solution = self.solution.clone();
        solution.nodes.fill(base);
        for (block, stage) in solution.stages.iter_mut().enumerate() {
            stage.inner = equations.reference_in(block);
            stage.closure_slope = Lanes::default();
        }
        for end in &mut solution.ends {
            end.closure_slope = Lanes::default();
        }
        turn_sections(&system.gauss, &mut solution);
        let mut unloaded = Self { equations, system, solution, determinant: Determinant::ONE };
        unloaded.linearise()?;
        let rates = scaled_rates(&unloaded.compliance(functions)?, functions, 1.0)?;
        rates.first().map(|rate| -rate[0]).filter(|decay| *decay > 0.0)
    }

    fn linearise(&mut self) -> Option<()> {
        linearise(&mut self.system, &self.equations, &self.solution).ok()?;
        self.determinant = self.system.determinant();
        if let Some(stroke_control) =
            self.equations.stroke_control.clone().filter(|stroke_control| stroke_control.taut.contains(&true))
        {
            let pulled = pull_taut(&self.equations, &self.system, &self.solution, &stroke_control);
            self.determinant = self.determinant.times(border(&stroke_control, &pulled)?);
        }
        Some(())
    }

    /// Whether so many growing directions have the parity that the determinant's sign asks for, where that sign is
    /// known.
    fn agrees_with(&self, count: usize) -> bool {
        self.determinant.known_sign().is_none_or(|sign| (sign > 0.0) == count.is_multiple_of(2))
    }

    fn compliance(&self, functions: usize) -> Option<Compliance> {
        let stroke_control =
            self.equations.stroke_control.clone().filter(|stroke_control| stroke_control.taut.contains(&true));
        let (mut pulled, mut taut) = (Vec::new(), Vec::new());
        if let Some(stroke_control) = &stroke_control {
            pulled = pull_taut(&self.equations, &self.system, &self.solution, stroke_control);
            taut = stroke_control.taut_cables();
        }
        let cables: Vec<usize> =
            stroke_control.iter().flat_map(|stroke_control| taut.iter().map(|i| stroke_control.cables[*i])).collect();
        let (equations, solution) = (&self.equations, &self.solution);
        let mut compliance =
            Compliance::new(&self.system, &solution.mesh, functions, cables.len(), |system, response| {
                cables.iter().map(|cable| equations.stroke_change(*cable, StationData::of(system), response)).collect()
            });
        let basis = Basis::new(&self.system.gauss.c, &solution.mesh, functions);
        let motion = |(pulled, cable): (&UnitPull<N, M, Q, L>, &usize)| {
            let change = response_change(equations, &self.system, solution, Way::Tension(*cable));
            project(&self.system, &basis, &pulled.response, &change)
        };
        let motions: Vec<Vec<f64>> = pulled.iter().zip(&cables).map(motion).collect();
        let strokes: Vec<Vec<f64>> =
            pulled.iter().map(|pulled| taut.iter().map(|i| pulled.strokes[*i]).collect()).collect();
        if !motions.is_empty() {
            compliance.hold(&motions, &strokes)?;
        }
        Some(compliance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arm, Cable, Displaced, Gravity, Options, Profile, Solver};

    /// A xorshift generator.
    struct Dice(u64);

    impl Dice {
        fn roll(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        fn between(&mut self, low: f64, high: f64) -> f64 {
            low + (high - low) * self.roll()
        }

        fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
            let fraction = self.roll() * of.len() as f64;
            *of.iter().enumerate().find(|(i, _)| fraction < (*i + 1) as f64).unwrap().1
        }
    }

    /// Cones in a stream and in gravity from all sides, half of them with a slack cable so that
    /// those against the stream or upright stay straight and unstable.
    fn random_arm(dice: &mut Dice) -> Arm {
        let length = dice.between(0.1, 0.4);
        let base = length * dice.between(0.03, 0.06);
        let tip = base * dice.between(0.1, 1.0);
        let young = 10_f64.powf(dice.between(4.0, 5.7));
        let mut arm = Arm::cone(length, base, tip, young, 0.5);
        arm.density = dice.between(1000.0, 1150.0);
        let fraction = dice.between(0.4, 0.8);
        let most = 0.05 * young * std::f64::consts::PI * tip * tip;
        let tension = dice.one_of(&[0.0, 1.0]) * most * dice.between(0.0, 1.5);
        arm.cables.push(Cable::new("left", Profile::linear(fraction * base, fraction * tip)).pulled(tension));
        arm.cables.push(Cable::new("right", Profile::linear(-fraction * base, -fraction * tip)));
        arm.base.angle = dice.one_of(&[0.0, std::f64::consts::FRAC_PI_2]);
        arm.flow.speed = dice.one_of(&[0.0, 1.0]) * dice.between(0.0, 1.0);
        arm.flow.direction = dice.one_of(&[0.0_f64, 60.0, 90.0, 180.0, 270.0]).to_radians();
        arm.gravity = dice.one_of(&[None, Some(Gravity::default())]);
        // The law by which the bounds of these tests were found.
        arm.model.displaced = Displaced::Section;
        arm
    }

    /// Where the count does not agree with the determinant or with twice the polynomials and elements, or the first
    /// rate is another one there.
    fn disagreement(dense: &Dense, found: &Growth, level: usize) -> Option<String> {
        let functions = 2 * POLYNOMIALS[level];
        let tangent = Tangent::new(dense, functions).unwrap();
        let compliance = tangent.compliance(functions).unwrap();
        let finer = scaled_rates(&compliance, functions, tangent.slowest_decay(functions).unwrap()).unwrap();
        let (count, first) = (growing(&found.rates), found.rates[0]);
        let off = (first[0] - finer[0][0]).hypot(first[1].abs() - finer[0][1].abs());
        let agrees = growing(&finer) == count
            && (found.stability() == Stability::Marginal || tangent.agrees_with(count))
            && off <= 0.02 * finer[0][0].hypot(finer[0][1]).max(0.1);
        (!agrees).then(|| format!("{:?}, {:?}, finer {:?}", tangent.determinant, found.rates, &finer[..6]))
    }

    /// The same arms with the strokes that their cables have commanded. Whether one more direction grows, or one less,
    /// than at given tensions is a matter of the strokes that more tension reels in, here by solves on both sides.
    #[test]
    fn counts_at_held_lengths_agree_with_the_determinant_with_twice_the_polynomials_and_with_solves() {
        let mut dice = Dice(23);
        let (mut solved, mut unsettled, mut differ, mut wrong) = (0, 0, 0, Vec::new());
        for case in 0..150 {
            let arm = random_arm(&mut dice);
            if arm.cables[0].tension == 0.0 {
                continue;
            }
            let mut solver = Solver::new(&arm, Options::with_tol(1e-10)).unwrap();
            let Ok(shape) = solver.solve() else { continue };
            let mut dense = shape.dense().clone();
            let mut commanded = arm.clone();
            commanded.cables[0].stroke = Some(shape.cables[0].stroke);
            dense.equations.set_loads(&commanded);
            dense.equations.hold_strokes();
            let (Some((pulled, _)), Some((found, level))) = (growth(shape.dense()), growth(&dense)) else {
                unsettled += 1;
                continue;
            };
            let mut stroke = |fraction: f64| {
                solver.set_tensions(&[fraction * arm.cables[0].tension, 0.0]).unwrap();
                solver.configuration().map(|shape| shape.cables[0].stroke)
            };
            let (Ok(less), Ok(more)) = (stroke(1.0 - 1e-4), stroke(1.0 + 1e-4)) else { continue };
            solved += 1;
            wrong.extend(disagreement(&dense, &found, level).map(|what| format!("{case}: {what}")));
            let one_apart = growing(&found.rates).abs_diff(growing(&pulled.rates)) % 2 == 1;
            differ += usize::from(one_apart);
            if one_apart != (more < less) {
                wrong.push(format!(
                    "{case}: {less} to {more} m, {:?} stroke_control, {:?} pulled",
                    found.rates, pulled.rates
                ));
            }
        }
        println!(
            "{solved} arms, {unsettled} unsettled, {differ} with another number of directions than at given tensions"
        );
        assert!(wrong.is_empty(), "{wrong:#?}");
        assert!(solved > 40 && unsettled <= 3 && differ > 0);
    }

    /// The counts are even where the determinant is positive and odd where it is negative, and stay when polynomials
    /// and elements are doubled; and the first rate moves by little then, and with the tolerance of the solve.
    #[test]
    fn counts_on_random_arms_agree_with_the_determinant_and_with_twice_the_polynomials() {
        let mut dice = Dice(11);
        let (mut solved, mut unstable, mut pairs, mut refined, mut unsettled) = (0, 0, 0, 0, 0);
        let mut by_tolerance = 0.0_f64;
        let mut wrong = Vec::new();
        for case in 0..300 {
            let arm = random_arm(&mut dice);
            let Ok(shape) = Solver::new(&arm, Options::default()).unwrap().solve() else { continue };
            solved += 1;
            let dense = shape.dense();
            let Some((found, level)) = growth(dense) else {
                unsettled += 1;
                continue;
            };
            refined += usize::from(level > 0);
            let count = growing(&found.rates);
            unstable += usize::from(count > 0);
            pairs += usize::from(count > 0 && found.rates[0][1] != 0.0);
            wrong.extend(disagreement(dense, &found, level).map(|what| format!("{case}: {what}")));
            if case < 100
                && let Ok(sharp) = Solver::new(&arm, Options::with_tol(1e-11)).unwrap().solve()
            {
                let sharp = sharp.growth().unwrap().rates[0];
                let off = (sharp[0] - found.rates[0][0]).abs() / sharp[0].abs().max(1.0);
                if count == 0 {
                    by_tolerance = by_tolerance.max(off);
                }
            }
        }
        println!(
            "{solved} arms, {unstable} unstable, {pairs} first by a pair, {refined} refined, {unsettled} unsettled, \
             tolerance moves the first rate by {by_tolerance:e}"
        );
        assert!(wrong.is_empty(), "{wrong:#?}");
        assert!(unstable > 5 && unsettled <= 3 && by_tolerance < 1e-5);
    }
}
