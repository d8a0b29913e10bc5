//! Tensions and slacks of the cables whose stroke is commanded through a step, and when they become slack or taut.

/// What cables do at one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Pull {
    /// s.
    pub(super) time: f64,
    /// Tensions of all cables, N.
    pub(super) tensions: Vec<f64>,
    /// Which held cables are taut.
    pub(super) taut: Vec<bool>,
    /// How far each held cable is from becoming slack or taut: the tension (N) of a taut one, the slack (over L) of
    /// one that hangs.
    pub(super) margins: Vec<f64>,
}

/// What cables do at the stages of a step.
#[derive(Debug, Clone)]
pub(super) struct Pulls {
    /// At the start of the step before, where loads go on smoothly from there.
    before: Option<Pull>,
    /// At the start of the step, and at its stages in their order, the last of which is its end.
    stages: Vec<Pull>,
}

impl Pulls {
    pub(super) fn new(start: Pull) -> Self {
        Self { before: None, stages: vec![start] }
    }

    /// Starts a step, or the same one anew.
    pub(super) fn start(&mut self, start: &Pull) {
        self.stages.clear();
        self.stages.push(start.clone());
    }

    /// Takes the next stage.
    pub(super) fn take(&mut self, stage: Pull) {
        self.stages.push(stage);
    }

    /// Takes the step for the one before the next, which loads go on smoothly to, or not.
    pub(super) fn accept(&mut self, smoothly: bool) {
        self.before = self.stages.first().filter(|_| smoothly).cloned();
    }

    /// The tension of a cable (N) at `time`, by straight lines between the stages.
    pub(super) fn tension_at(&self, cable: usize, time: f64) -> f64 {
        let before = self.stages.iter().filter(|at| at.time <= time).max_by(|a, b| a.time.total_cmp(&b.time));
        let after = self.stages.iter().filter(|at| at.time >= time).min_by(|a, b| a.time.total_cmp(&b.time));
        match (before, after) {
            (Some(a), Some(b)) if b.time > a.time => {
                a.tensions[cable] + (b.tensions[cable] - a.tensions[cable]) * (time - a.time) / (b.time - a.time)
            }
            (Some(at), _) | (None, Some(at)) => at.tensions[cable],
            (None, None) => 0.0,
        }
    }

    /// The held cables that are slack at the end of the step and were taut at its start, or the other way round, by
    /// their place in the list: when, and whether they are taut then.
    pub(super) fn changes(&self) -> Vec<(usize, f64, bool)> {
        let [Some(first), Some(last)] = [self.stages.first(), self.stages.last()] else { return Vec::new() };
        let both = first.taut.iter().zip(&last.taut).enumerate();
        both.filter(|(_, (a, b))| a != b).map(|(index, (_, taut))| (index, self.change_of(index), *taut)).collect()
    }

    /// When held cable `index` changes in the step: where the straight line through its last two margins passes zero,
    /// kept between the last stage before and the first one after.
    fn change_of(&self, index: usize) -> f64 {
        let mut stages: Vec<&Pull> = self.stages.iter().collect();
        stages.sort_by(|a, b| a.time.total_cmp(&b.time));
        let was = stages[0].taut[index];
        let after = stages.iter().position(|at| at.taut[index] != was).unwrap_or(stages.len() - 1).max(1);
        let (b, end) = (stages[after - 1], stages[after].time);
        let earlier = if after > 1 { Some(stages[after - 2]) } else { self.before.as_ref() };
        let falling = earlier.filter(|a| a.taut[index] == was && a.margins[index] > b.margins[index]);
        let zero = falling.map_or(end, |a| {
            b.time + b.margins[index].max(0.0) * (b.time - a.time) / (a.margins[index] - b.margins[index])
        });
        zero.clamp(b.time, end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pull(time: f64, taut: bool, margin: f64) -> Pull {
        Pull { time, tensions: vec![if taut { margin } else { 0.0 }], taut: vec![taut], margins: vec![margin] }
    }

    fn step(stages: &[(f64, bool, f64)]) -> Pulls {
        let mut stages = stages.iter().map(|(time, taut, margin)| pull(*time, *taut, *margin));
        let mut out = Pulls::new(stages.next().unwrap());
        stages.for_each(|stage| out.take(stage));
        out
    }

    #[test]
    fn a_change_is_where_the_margin_passes_zero() {
        // Stages are not in the order of their times.
        let slackens = step(&[(1.0, true, 0.5), (1.5, false, 0.0), (1.3, true, 0.2), (2.0, false, 0.1)]);
        let [(0, time, false)] = slackens.changes()[..] else { panic!("{:?}", slackens.changes()) };
        assert!((time - 1.5).abs() < 1e-12, "{time}");
        let tautens = step(&[(1.0, false, 0.3), (1.25, false, 0.1), (2.0, true, 0.4)]);
        let [(0, time, true)] = tautens.changes()[..] else { panic!("{:?}", tautens.changes()) };
        assert!((time - 1.375).abs() < 1e-12, "{time}");
        assert!(step(&[(1.0, true, 0.5), (2.0, true, 0.1)]).changes().is_empty());
    }

    #[test]
    fn the_step_before_tells_the_slope_unless_loads_have_a_corner_between() {
        let mut pulls = step(&[(0.0, true, 0.4), (1.0, true, 0.2)]);
        for (smoothly, expected) in [(true, 2.0), (false, 3.0)] {
            pulls.start(&pull(0.0, true, 0.4));
            pulls.take(pull(1.0, true, 0.2));
            pulls.accept(smoothly);
            pulls.start(&pull(1.0, true, 0.2));
            pulls.take(pull(3.0, false, 0.1));
            let [(0, time, false)] = pulls.changes()[..] else { panic!("{:?}", pulls.changes()) };
            assert!((time - expected).abs() < 1e-12, "{time}");
        }
    }
}
