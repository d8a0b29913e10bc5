//! Where on a step an event is: zeros of functions that are known at a few places.

/// A zero between two places at which a function has different signs, by false position (regula falsi) with the Illinois
/// modification: an end that stays a second time has its value halved, so that both come in.
#[derive(Debug, Clone, Copy)]
pub struct RegulaFalsi {
    low: (f64, f64),
    high: (f64, f64),
    /// The last value.
    before: f64,
}

impl RegulaFalsi {
    /// Between two places with their values, the first positive, the second negative.
    pub fn between(low: (f64, f64), high: (f64, f64)) -> Self {
        Self { low, high, before: 0.0 }
    }

    /// The next place to look at: no nearer to either end than the part `margin` of the way.
    pub fn place(&self, margin: f64) -> f64 {
        let fraction = (self.low.1 / (self.low.1 - self.high.1)).clamp(margin, 1.0 - margin);
        self.low.0 + fraction * (self.high.0 - self.low.0)
    }

    /// Takes the value at a place in between.
    pub fn put(&mut self, place: f64, value: f64) {
        if value < 0.0 {
            self.high = (place, value);
            self.low.1 *= if self.before < 0.0 { 0.5 } else { 1.0 };
        } else {
            self.low = (place, value);
            self.high.1 *= if self.before > 0.0 { 0.5 } else { 1.0 };
        }
        self.before = value;
    }

    /// Takes a place in between that has no value for the far end.
    pub fn shorten(&mut self, place: f64) {
        self.high.0 = place;
    }

    /// How far apart the ends are.
    pub fn width(&self) -> f64 {
        self.high.0 - self.low.0
    }
}

/// The place at which a smooth function is zero, by inverse interpolation of places over values (Neville's scheme): `samples` are places with
/// values, no two of which are the same.
pub fn inverse_interpolation(samples: &[(f64, f64)]) -> f64 {
    let mut column: Vec<f64> = samples.iter().map(|(place, _)| *place).collect();
    for order in 1..samples.len() {
        for k in 0..samples.len() - order {
            let (a, b) = (samples[k].1, samples[k + order].1);
            column[k] = (b * column[k] - a * column[k + 1]) / (b - a);
        }
    }
    column.first().copied().unwrap_or(f64::NAN)
}

/// How far to go along the tangent of a one-parameter family so that a linear condition holds after the Newton correction (bordering): `rest`
/// and `response` are what the condition says of the correction and of the change a unit of the parameter, `by_parameter` what
/// it says of the parameter itself.
#[inline(always)]
pub fn bordered(rest: f64, response: f64, by_parameter: f64) -> f64 {
    -rest / (response + by_parameter)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn false_position_comes_in_from_both_sides() {
        // Strongly curved: plain false position would keep one end.
        let f = |x: f64| 1.0 - x.powi(9);
        let mut search = RegulaFalsi::between((0.0, f(0.0)), (2.0, f(2.0)));
        for _ in 0..60 {
            let x = search.place(0.01);
            search.put(x, f(x));
            if f(x).abs() < 1e-13 {
                return;
            }
        }
        panic!("{search:?}");
    }

    #[test]
    fn inverse_interpolation_is_exact_for_inverses_of_low_degree() {
        let place = |value: f64| 0.3 + value - 2.0 * value * value;
        let samples = [0.1, -0.05, 0.2].map(|value| (place(value), value));
        assert!((inverse_interpolation(&samples) - 0.3).abs() < 1e-14);
    }
}
