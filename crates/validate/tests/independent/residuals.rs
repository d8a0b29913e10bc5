//! How far an answer misses each equation of the model: by its own strains, without looking for the equilibrium beside it.

use hydrostat::{Configuration, Station};

use crate::mechanics::{Model, advance, beta};
use crate::polynomials::Points;
use crate::shape::{POINTS, Shape};

/// The largest over the arm. Lengths are over L, so that each is about the tip's displacement that it could cause by itself;
/// forces and moments over the largest that the arm carries, tensions included.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Residuals {
    /// n, m against the section law (11), (12), (14), as the strains that would make the difference (mu by L).
    pub(crate) law: f64,
    /// beta against the volume law of section 4, and alpha against atan2(eta, nu).
    pub(crate) volume: f64,
    /// beta' against the slope of beta, by the radius.
    pub(crate) swelling: f64,
    /// theta, x, y against the integrals of mu and r' from the base.
    pub(crate) place: f64,
    /// n_f, m_f of the strains against the tip's loads and the integral of the loads beyond.
    pub(crate) balance: f64,
    /// The base reaction against -n_f(0), -m_f(0) of the strains.
    pub(crate) reaction: f64,
    /// With an unstrained base: what is said to be unmet at the tip against what is.
    pub(crate) unmet: f64,
    /// Lengths and strokes of cables against the integrals of |tau|.
    pub(crate) stroke: f64,
    /// Commanded cables against their command, stretch included; slack ones by what is too short, or by a tension.
    pub(crate) command: f64,
}

impl Residuals {
    pub(crate) fn largest(&self) -> f64 {
        let all = [
            self.law,
            self.volume,
            self.swelling,
            self.place,
            self.balance,
            self.reaction,
            self.unmet,
            self.stroke,
            self.command,
        ];
        all.into_iter().fold(0.0, |most: f64, own| if own > most || own.is_nan() { own } else { most })
    }
}

fn raise(most: &mut f64, value: f64) {
    if value.is_nan() || value.abs() > *most {
        *most = value.abs();
    }
}

/// Of an answer.
pub(crate) fn residuals(model: &Model, solved: &Configuration) -> Residuals {
    let points = Points::new(POINTS);
    let shape = Shape::read(model, &points, solved, 1);
    let mut out = Residuals::default();
    local(&shape, solved, &mut out);
    places(&shape, solved, &mut out);
    balances(&shape, solved, &mut out);
    cables(&shape, solved, &mut out);
    out
}

/// What holds at every place by itself.
fn local(shape: &Shape<'_>, solved: &Configuration, out: &mut Residuals) {
    let (model, length) = (shape.model, shape.model.arm.length);
    let mut check = |place: &crate::mechanics::Place, station: &Station| {
        let e = [station.nu, station.eta, station.mu];
        let swollen = beta(model.arm.model.volume, station.nu)[0];
        let got = model.stress(place, e);
        for (k, said) in [station.n_a, station.n_b, station.m].into_iter().enumerate() {
            let by = if k == 2 { length } else { 1.0 };
            raise(&mut out.law, by * (got[k] - said) / (place.stiffness[k] * swollen * swollen));
        }
        raise(&mut out.volume, station.beta / swollen - 1.0);
        raise(&mut out.volume, station.alpha - station.eta.atan2(station.nu));
    };
    for element in &shape.elements {
        for place in &element.places {
            check(place, &solved.at(place.s));
        }
    }
    let st = &solved.stations;
    for k in 0..st.len() {
        let twice = |other: usize| st.s[other] == st.s[k];
        // At the end of a cable the first is the base's side.
        let inside = if k + 1 < st.len() && twice(k + 1) || k + 1 == st.len() { -1.0 } else { 1.0 };
        let place = model.place(st.s[k], st.s[k] + inside * 1e-6 * length);
        let station = Station {
            s: st.s[k],
            nu: st.nu[k],
            eta: st.eta[k],
            mu: st.mu[k],
            beta: st.beta[k],
            alpha: st.alpha[k],
            n_a: st.n_a[k],
            n_b: st.n_b[k],
            m: st.m[k],
            ..Station::default()
        };
        check(&place, &station);
    }
    for element in &shape.elements {
        for (j, place) in element.places.iter().enumerate() {
            let said = solved.at(place.s).beta_slope;
            raise(&mut out.swelling, (said - element.beta_slope[j]) * place.radius);
        }
    }
}

/// theta, x and y along the arm.
fn places(shape: &Shape<'_>, solved: &Configuration, out: &mut Residuals) {
    let (model, length) = (shape.model, shape.model.arm.length);
    let base = &model.arm.base;
    let mut reached = [base.angle, base.x, base.y];
    let mut compare = |station: &Station, reached: &[f64; 3]| {
        raise(&mut out.place, station.theta - reached[0]);
        raise(&mut out.place, (station.x - reached[1]) / length);
        raise(&mut out.place, (station.y - reached[2]) / length);
    };
    for element in &shape.elements {
        compare(&solved.at(element.from), &reached);
        for (j, weight) in shape.points.weight.iter().enumerate() {
            let along = advance(element.theta[j], element.strains[j]);
            for (reached, slope) in reached.iter_mut().zip([element.strains[j][2], along[0], along[1]]) {
                *reached += element.step * weight * slope;
            }
        }
    }
    compare(&solved.at(length), &reached);
    let (tip, st) = (solved.tip(), &solved.stations);
    let last = st.len() - 1;
    let tip = Station { theta: tip.theta, x: tip.x, y: tip.y, ..Station::default() };
    compare(&tip, &reached);
    compare(&Station { theta: st.theta[last], x: st.x[last], y: st.y[last], ..Station::default() }, &reached);
}

/// Forces and moments: what acts beyond every place against what the strains there carry.
fn balances(shape: &Shape<'_>, solved: &Configuration, out: &mut Residuals) {
    let (model, length) = (shape.model, shape.model.arm.length);
    let arm = &model.arm;
    let carried: Vec<Vec<crate::mechanics::State>> = (0..shape.elements.len()).map(|k| shape.states(k)).collect();
    let force = carried.iter().flatten().map(|z| z[1].hypot(z[2])).fold(0.0, f64::max);
    let moment = carried.iter().flatten().map(|z| z[3].abs()).fold(0.0, f64::max);
    let pulls: f64 = shape.tensions.iter().sum();
    let force = force.max(pulls).max(1e-5 * model.place(0.0, 0.0).stiffness[2] / (length * length));
    let moment = moment.max(1e-2 * force * length);
    let tip = solved.tip();
    let loads = model.tip_load(tip.theta);
    let (first, last) = (0, shape.elements.len() - 1);
    let at = |k: usize, x: f64| {
        [0, 1, 2, 3].map(|c| shape.points.value(&carried[k].iter().map(|z| z[c]).collect::<Vec<f64>>(), x))
    };
    let unstrained = arm.model.support == hydrostat::Support::UnstrainedBase;
    // n_f(L), m_f(L): the loads of the tip, or what the integration from the base leaves there.
    let mut beyond = if unstrained { at(last, 1.0)[1..].try_into().unwrap_or(loads) } else { loads };
    if let Some(unmet) = &solved.unmet {
        let said = [unmet.force[0], unmet.force[1], unmet.moment];
        for k in 0..3 {
            let size = if k == 2 { moment } else { force };
            raise(&mut out.unmet, (said[k] - (beyond[k] - loads[k])) / size);
        }
    }
    for k in (first..=last).rev() {
        let element = &shape.elements[k];
        for (j, weight) in shape.points.weight.iter().enumerate() {
            let (e, theta) = (element.strains[j], element.theta[j]);
            let z = [theta, carried[k][j][1], carried[k][j][2], carried[k][j][3]];
            let slopes = model.slopes(&element.places[j], z, e, element.beta_slope[j]);
            for (beyond, slope) in beyond.iter_mut().zip(&slopes[1..]) {
                *beyond -= element.step * weight * slope;
            }
        }
        let here = at(k, 0.0);
        for c in 0..3 {
            let size = if c == 2 { moment } else { force };
            raise(&mut out.balance, (beyond[c] - here[c + 1]) / size);
        }
    }
    let reaction = &solved.base_reaction;
    let said = [reaction.force[0], reaction.force[1], reaction.moment];
    for c in 0..3 {
        let size = if c == 2 { moment } else { force };
        raise(&mut out.reaction, (said[c] + beyond[c]) / size);
    }
}

fn cables(shape: &Shape<'_>, solved: &Configuration, out: &mut Residuals) {
    let length = shape.model.arm.length;
    for (i, state) in solved.cables.iter().enumerate() {
        let [now, unloaded] = shape.lengths(i);
        raise(&mut out.stroke, (state.length - now) / length);
        raise(&mut out.stroke, (state.stroke - (unloaded - now)) / length);
        raise(&mut out.stroke, (state.tension - shape.tensions[i]) / state.tension.abs().max(1e-300));
        let Some(command) = &state.command else { continue };
        raise(&mut out.stroke, (command.length - (unloaded - command.stroke)) / length);
        let over = (shape.unstretched(i) - command.length) / length;
        if command.slack {
            // A slack cable is longer than its path, and does not pull.
            raise(&mut out.command, over.max(0.0));
            raise(&mut out.command, state.tension);
        } else {
            raise(&mut out.command, over);
            raise(&mut out.command, state.tension.min(0.0));
        }
    }
}
