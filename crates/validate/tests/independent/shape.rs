//! A configuration read out as polynomials between the nodes of its mesh, the places at which an arm changes its law and the
//! places at which its loads have kinks, with what follows from them: beta', turns and tensions of cables, strokes.

use hydrostat::Configuration;

use crate::mechanics::{Model, Place, State, Strains, advance, beta};
use crate::polynomials::Points;

/// Gauss points of an element.
pub(crate) const POINTS: usize = 8;

/// Places to look for changes of sign at, an element.
const LOOKS: usize = 12;

/// Nodes are no closer than this, over L: slopes of polynomials on short elements are rounding.
const CLOSEST: f64 = 3e-4;

/// Kinks this near each other, over L, are one: slopes of beta' have rounding, and may jump there.
const APART: f64 = 3e-4;

/// Nodes this near a kink, over the shorter element beside them, give way to it.
const BESIDE: f64 = 0.25;

/// An arm in a shape, at the Gauss points of elements.
pub(crate) struct Shape<'a> {
    pub(crate) model: &'a Model,
    pub(crate) points: &'a Points,
    /// Nodes but for those at kinks.
    regular: Vec<f64>,
    pub(crate) nodes: Vec<f64>,
    breaks: Vec<f64>,
    pub(crate) elements: Vec<Element>,
    /// At the base, in the order of the cables.
    pub(crate) tensions: Vec<f64>,
}

pub(crate) struct Element {
    pub(crate) from: f64,
    pub(crate) step: f64,
    pub(crate) places: Vec<Place>,
    pub(crate) theta: Vec<f64>,
    pub(crate) strains: Vec<Strains>,
    /// beta' at the points.
    pub(crate) beta_slope: Vec<f64>,
    /// Tensions of all cables where it starts.
    pub(crate) start: Vec<f64>,
    /// The same at the points.
    pub(crate) tensions: Vec<Vec<f64>>,
    /// Where in the element each cable with friction begins to turn another way, and which way.
    pub(crate) senses: Vec<Vec<(f64, f64)>>,
}

impl Element {
    fn new(model: &Model, points: &Points, from: f64, to: f64) -> Self {
        let (step, middle) = (to - from, 0.5 * (from + to));
        let count = points.count();
        Self {
            from,
            step,
            places: points.at.iter().map(|x| model.place(from + step * x, middle)).collect(),
            theta: vec![0.0; count],
            strains: vec![[1.0, 0.0, 0.0]; count],
            beta_slope: vec![0.0; count],
            start: Vec::new(),
            tensions: Vec::new(),
            senses: Vec::new(),
        }
    }

    /// beta' as the slope of the polynomial through beta at the points.
    pub(crate) fn follow_beta(&mut self, model: &Model, points: &Points) {
        let volume = model.arm.model.volume;
        let values: Vec<f64> = self.strains.iter().map(|e| beta(volume, e[0])[0]).collect();
        self.beta_slope = points.slopes(&values).iter().map(|slope| slope / self.step).collect();
    }

    /// Angle chi of cable `index` in space at the points, without jumps of a full turn.
    pub(crate) fn directions(&self, model: &Model, index: usize) -> Option<Vec<f64>> {
        let mut out: Vec<f64> = Vec::with_capacity(self.places.len());
        for (j, place) in self.places.iter().enumerate() {
            let cable = place.cables.iter().find(|cable| cable.index == index)?;
            let [x, z] = model.tau(cable, self.strains[j], self.beta_slope[j]);
            let chi = self.theta[j] + z.atan2(x);
            let turns = out.last().map_or(0.0, |last| ((last - chi) / std::f64::consts::TAU).round());
            out.push(chi + turns * std::f64::consts::TAU);
        }
        Some(out)
    }
}

impl<'a> Shape<'a> {
    /// Of a configuration, on its nodes with `parts` elements between two of them, and nodes where its own polynomials show
    /// kinks.
    pub(crate) fn read(model: &'a Model, points: &'a Points, solved: &Configuration, parts: u32) -> Self {
        let tensions = model.arm.cables.iter().map(|cable| cable.tension).collect();
        let breaks = model.breaks();
        let mut nodes = breaks.clone();
        nodes.extend(&solved.stations.s);
        sort(&mut nodes, model.arm.length, &breaks);
        let between = |w: &[f64]| -> Vec<f64> {
            (1..parts).map(|k| w[0] + (w[1] - w[0]) * f64::from(k) / f64::from(parts)).collect()
        };
        let inner: Vec<f64> = nodes.windows(2).flat_map(between).collect();
        nodes.extend(inner);
        sort(&mut nodes, model.arm.length, &breaks);
        let mut out = Self { model, points, regular: nodes, nodes: Vec::new(), breaks, elements: Vec::new(), tensions };
        let station = |s: f64| {
            let station = solved.at(s);
            (station.theta, [station.nu, station.eta, station.mu])
        };
        out.fill(&station);
        out.divide(&out.kinks(), &station);
        out
    }

    /// Puts nodes on the kinks that the present shape has, in place of those that it had.
    pub(crate) fn move_kinks(&mut self) {
        let (places, points) = (self.kinks(), self.points);
        let old = std::mem::take(&mut self.elements);
        let station = |s: f64| {
            let k = (1..old.len()).take_while(|k| old[*k].from <= s).count();
            let basis = points.basis((s - old[k].from) / old[k].step);
            let value = |at: &dyn Fn(usize) -> f64| basis.iter().enumerate().map(|(j, own)| own * at(j)).sum::<f64>();
            (value(&|j| old[k].theta[j]), [0, 1, 2].map(|c| value(&|j| old[k].strains[j][c])))
        };
        self.divide(&places, &station);
    }

    fn divide(&mut self, kinks: &[f64], station: &dyn Fn(f64) -> (f64, Strains)) {
        // A node of the configuration beside a kink was meant to be on it.
        let regular = &self.regular;
        let near = |k: usize| {
            let gap = (regular[k + 1] - regular[k]).min(regular[k] - regular[k - 1]);
            BESIDE * gap
        };
        let apart = |k: usize| kinks.iter().all(|kink| (kink - regular[k]).abs() > near(k));
        let stays = |k: &usize| self.breaks.contains(&regular[*k]) || apart(*k);
        self.nodes = (0..regular.len()).filter(stays).map(|k| regular[k]).collect();
        self.nodes.extend(kinks);
        sort(&mut self.nodes, self.model.arm.length, &self.breaks);
        self.fill(station);
    }

    /// Elements between the nodes, with theta and the strains at `station`.
    fn fill(&mut self, station: &dyn Fn(f64) -> (f64, Strains)) {
        let (model, points) = (self.model, self.points);
        self.elements = self.nodes.windows(2).map(|w| Element::new(model, points, w[0], w[1])).collect();
        for element in &mut self.elements {
            for j in 0..points.count() {
                (element.theta[j], element.strains[j]) = station(element.places[j].s);
            }
            element.follow_beta(model, points);
        }
        self.rub();
    }

    /// Tensions along the arm by the capstan law: T(s) = T(0) exp(-+ friction Phi(s)), Phi the integral of |chi'|.
    pub(crate) fn rub(&mut self) {
        let closest = CLOSEST * self.model.arm.length;
        for element in &mut self.elements {
            element.start.clone_from(&self.tensions);
            element.senses = vec![vec![(0.0, 1.0)]; self.tensions.len()];
        }
        for cable in 0..self.tensions.len() {
            let grip = self.model.grip(cable);
            if grip == 0.0 {
                continue;
            }
            let (mut turned, mut before) = (0.0, None);
            for element in &mut self.elements {
                let Some(chi) = element.directions(self.model, cable) else { break };
                let [start, end] = [0.0, 1.0].map(|x| self.points.value(&chi, x));
                // Steps are where the arm changes its law; elsewhere they are rounding.
                let steps = self.breaks.iter().any(|s| (s - element.from).abs() <= closest);
                turned += before.filter(|_| steps).map_or(0.0, |before: f64| whole_turns_off(start - before).abs());
                element.start[cable] *= (grip * turned).exp();
                element.senses[cable] = senses_of(self.points, &chi);
                turned += turned_to(self.points, &chi, &element.senses[cable], 1.0);
                before = Some(end);
            }
        }
        for element in &mut self.elements {
            element.follow_turns(self.model, self.points);
        }
    }

    /// Where the loads of the stream have kinks, and where cables with friction begin to turn the other way.
    fn kinks(&self) -> Vec<f64> {
        let rubs: Vec<usize> = (0..self.tensions.len()).filter(|cable| self.model.grip(*cable) != 0.0).collect();
        // What changes its sign there: by element, by quantity, at the points.
        let switches: Vec<Vec<Vec<f64>>> = self.elements.iter().map(|element| self.switches(element, &rubs)).collect();
        let mut out = Vec::new();
        for (k, (element, own)) in self.elements.iter().zip(&switches).enumerate() {
            for (i, values) in own.iter().enumerate() {
                self.changes(element, values, [0.0, 1.0], &mut out);
                let Some(next) = switches.get(k + 1).and_then(|next| next.get(i)) else { continue };
                let sides = [self.points.value(values, 1.0), self.points.value(next, 0.0)];
                if sides[0] * sides[1] < 0.0 {
                    // At the node, or a little beyond it by the one or the other side's polynomial.
                    let found = out.len();
                    self.changes(element, values, [1.0, 1.1], &mut out);
                    if out.len() == found {
                        self.changes(&self.elements[k + 1], next, [-0.1, 0.0], &mut out);
                    }
                    if out.len() == found {
                        out.push(self.elements[k + 1].from);
                    }
                }
            }
        }
        out.retain(|s| *s > 0.0 && *s < self.model.arm.length);
        out.sort_by(f64::total_cmp);
        out.dedup_by(|b, a| *b - *a <= APART * self.model.arm.length);
        out
    }

    /// Quantities whose changes of sign are kinks, at the points; zeros where they are rounding.
    fn switches(&self, element: &Element, rubs: &[usize]) -> Vec<Vec<f64>> {
        let count = self.points.count();
        let stream: Vec<Vec<f64>> = (0..count)
            .map(|j| {
                let (theta, e, slope) = (element.theta[j], element.strains[j], element.beta_slope[j]);
                self.model.switches(&element.places[j], theta, e, slope)
            })
            .collect();
        let unless_rounding = |values: Vec<f64>, rounding: f64| {
            if values.iter().all(|v| v.abs() < rounding) { vec![0.0; count] } else { values }
        };
        let mut out: Vec<Vec<f64>> =
            (0..stream[0].len()).map(|k| unless_rounding(stream.iter().map(|own| own[k]).collect(), 1e-13)).collect();
        for cable in rubs {
            let turns = element.directions(self.model, *cable).map(|chi| self.points.slopes(&chi));
            let by_length = |slope: &f64| slope / element.step * self.model.arm.length;
            out.push(turns.map_or(vec![0.0; count], |own| unless_rounding(own, 1e-10).iter().map(by_length).collect()));
        }
        out
    }

    /// Where the polynomial through `values` changes its sign, by x in the element.
    fn changes(&self, element: &Element, values: &[f64], within: [f64; 2], out: &mut Vec<f64>) {
        let first = out.len();
        changes_of(self.points, values, within, out);
        out[first..].iter_mut().for_each(|x| *x = element.from + element.step * *x);
    }

    /// State at the points of element `k` that its strains carry.
    pub(crate) fn states(&self, k: usize) -> Vec<State> {
        let element = &self.elements[k];
        (0..self.points.count())
            .map(|j| {
                let (e, slope) = (element.strains[j], element.beta_slope[j]);
                self.model.state(&element.places[j], &element.tensions[j], element.theta[j], e, slope)
            })
            .collect()
    }

    /// Sum over the arm of a quantity at the points, by length.
    pub(crate) fn integral(&self, mut quantity: impl FnMut(&Element, usize) -> f64) -> f64 {
        let mut sum = 0.0;
        for element in &self.elements {
            for (j, weight) in self.points.weight.iter().enumerate() {
                sum += element.step * weight * quantity(element, j);
            }
        }
        sum
    }

    /// Length of a cable's path, and of its path at the reference strains.
    pub(crate) fn lengths(&self, cable: usize) -> [f64; 2] {
        let model = self.model;
        let here =
            |element: &Element, j: usize| element.places[j].cables.iter().find(|own| own.index == cable).copied();
        let now = self.integral(|element, j| {
            here(element, j).map_or(0.0, |own| {
                let [x, z] = model.tau(&own, element.strains[j], element.beta_slope[j]);
                x.hypot(z)
            })
        });
        let unloaded = self.integral(|element, j| {
            here(element, j).map_or(0.0, |own| {
                let place = &element.places[j];
                let slope = beta(model.arm.model.volume, place.reference[0])[1] * place.reference_slope;
                let [x, z] = model.tau(&own, place.reference, slope);
                x.hypot(z)
            })
        });
        [now, unloaded]
    }

    /// Length that a cable of stiffness EA has when nothing pulls it, by the integral of |tau| / (1 + T(s)/EA).
    pub(crate) fn unstretched(&self, cable: usize) -> f64 {
        let stiffness = self.model.arm.cables[cable].stiffness;
        self.integral(|element, j| {
            let own = element.places[j].cables.iter().find(|own| own.index == cable);
            own.map_or(0.0, |own| {
                let [x, z] = self.model.tau(own, element.strains[j], element.beta_slope[j]);
                x.hypot(z) / (1.0 + stiffness.map_or(0.0, |ea| element.tensions[j][cable] / ea))
            })
        })
    }

    /// The tip: base and the integral of r'.
    pub(crate) fn tip(&self) -> [f64; 2] {
        let along = |k: usize| self.integral(|element, j| advance(element.theta[j], element.strains[j])[k]);
        [self.model.arm.base.x + along(0), self.model.arm.base.y + along(1)]
    }
}

/// Where the polynomial through `values` changes its sign, by x.
fn changes_of(points: &Points, values: &[f64], [from, to]: [f64; 2], out: &mut Vec<f64>) {
    let at = |x: f64| points.value(values, x);
    let looks: Vec<f64> = (0..=LOOKS).map(|k| from + (to - from) * k as f64 / LOOKS as f64).collect();
    for ends in looks.windows(2) {
        let (mut low, mut high) = (ends[0], ends[1]);
        let sign = at(low);
        if sign * at(high) >= 0.0 {
            continue;
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let same = at(middle) * sign > 0.0;
            if same { low = middle } else { high = middle }
        }
        out.push(high);
    }
}

/// Where in an element chi turns back, and which way it goes from there on.
fn senses_of(points: &Points, chi: &[f64]) -> Vec<(f64, f64)> {
    let slopes = points.slopes(chi);
    let mut begins = vec![0.0];
    if slopes.iter().any(|slope| slope.abs() >= 1e-10) {
        changes_of(points, &slopes, [0.0, 1.0], &mut begins);
    }
    let along = |k: usize| {
        let to = begins.get(k + 1).copied().unwrap_or(1.0);
        points.value(chi, to) - points.value(chi, begins[k])
    };
    (0..begins.len()).map(|k| (begins[k], along(k).signum())).collect()
}

/// How far chi turns from the start of an element to `x`, one way and the other.
pub(crate) fn turned_to(points: &Points, chi: &[f64], senses: &[(f64, f64)], x: f64) -> f64 {
    let parts = senses.iter().enumerate().filter(|(_, (from, _))| *from <= x);
    parts
        .map(|(k, (from, sense))| {
            let to = senses.get(k + 1).map_or(x, |next| next.0.min(x));
            sense * (points.value(chi, to) - points.value(chi, *from))
        })
        .sum()
}

fn whole_turns_off(angle: f64) -> f64 {
    angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round()
}

/// Sorts nodes; of those that are too near each other the arm's own stay.
fn sort(nodes: &mut Vec<f64>, length: f64, kept: &[f64]) {
    let least = CLOSEST * length;
    nodes.retain(|s| kept.contains(s) || kept.iter().all(|own| (own - s).abs() > least));
    nodes.sort_by(f64::total_cmp);
    nodes.dedup_by(|b, a| *b - *a <= least);
}
