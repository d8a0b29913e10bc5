//! Estimates and intervals on synthetic data with known truth.

use hydrostat::Parameter;
use hydrostat_identify::{Case, Finding, Fit, FitOptions, Fitted, Loss, Prior, Progress, Quantity, Unknown, fit};

mod common;
use common::{Random, exact, loads, markers, noisy, silicone};

const QUICK: FitOptions = FitOptions { loss: Loss::None, rescale: false, cross_validate: false, tol: 1e-6, rounds: 50 };

fn wanted(parameters: &[Parameter]) -> Vec<Fitted> {
    parameters.iter().map(|parameter| Fitted::new(*parameter, &silicone()).unwrap()).collect()
}

fn found(cases: &[Case], wanted: &[Fitted], options: &FitOptions) -> Fit {
    let found = fit(cases, wanted, options, |_| true).unwrap();
    assert!(found.converged);
    found
}

/// How often of `sets` intervals hold the truth, one share a parameter.
fn coverage(sets: u64, options: &FitOptions, stated: f64) -> Vec<f64> {
    let parameters = [Parameter::Young, Parameter::DragNormal, Parameter::Density];
    let truths = [110e3, 2.5, 1080.0];
    let cases = exact(&loads(), &markers(3), |_| 1e-3);
    let wanted = wanted(&parameters);
    let mut held = [0_u64; 3];
    for seed in 0..sets {
        let mut data = noisy(&cases, &mut Random::new(seed));
        for one in data.iter_mut().flat_map(|case| &mut case.measurements) {
            one.sd *= stated;
        }
        let fit = found(&data, &wanted, options);
        for ((held, one), truth) in held.iter_mut().zip(&fit.estimates).zip(truths) {
            let [from, to] = one.interval.unwrap();
            *held += u64::from((from..=to).contains(&truth));
        }
    }
    held.iter().map(|held| *held as f64 / sets as f64).collect()
}

fn is_95(fractions: &[f64], off: f64) {
    for fraction in fractions {
        assert!((fraction - 0.95).abs() <= off, "{fractions:?}");
    }
}

/// What 1000 data sets leave open is 0.007 (one standard deviation).
#[test]
fn intervals_of_1000_data_sets_hold_the_truth_92_to_98_percent_of_the_time() {
    let fractions = coverage(1000, &QUICK, 1.0);
    println!("{fractions:?}");
    is_95(&fractions, 0.03);
}

/// With standard deviations three times too small or too large, and intervals from the residuals.
#[test]
fn rescaled_intervals_hold_the_truth_whatever_was_stated() {
    for stated in [1.0 / 3.0, 3.0] {
        is_95(&coverage(60, &FitOptions { rescale: true, ..QUICK }, stated), 0.1);
    }
}

#[test]
fn intervals_of_a_robust_loss_hold_the_truth() {
    is_95(&coverage(60, &FitOptions { loss: Loss::Huber, ..QUICK }, 1.0), 0.1);
}

/// Quadratic drag goes with the density of the water times the coefficient: without weight nothing tells them apart.
#[test]
fn a_pair_that_cannot_be_told_apart_is_called_so() {
    let arms: Vec<_> = loads().into_iter().filter(|(name, _)| name != "weight").collect();
    let cases = noisy(&exact(&arms, &markers(3), |_| 1e-3), &mut Random::new(7));
    let mut wanted = wanted(&[Parameter::Young, Parameter::FlowDensity, Parameter::DragNormal]);
    let fit = found(&cases, &wanted, &QUICK);
    let pair = |finding: &Finding| match finding {
        Finding::Inseparable { parameters, .. } => {
            let names: Vec<Unknown> = parameters.iter().map(|(parameter, _)| *parameter).collect();
            names == [Parameter::FlowDensity, Parameter::DragNormal] && (parameters[0].1 + parameters[1].1).abs() < 0.01
        }
        _ => false,
    };
    assert!(fit.findings.iter().any(pair), "{:?}", fit.findings);
    let words = fit.verdict().join("\n");
    assert!(words.contains("the data do not separate flow.density and flow.cn: flow.density "), "{words}");
    assert!(words.contains("Fix one of them, add a prior"), "{words}");
    // A prior on one of them makes the other known.
    wanted[1].prior = Some(Prior { mean: 1022.0, sd: 2.0 });
    let fit = found(&cases, &wanted, &QUICK);
    let drag = &fit.estimates[2];
    assert!(drag.sd.unwrap() < 0.2 && (drag.value - 2.5).abs() < 4.0 * drag.sd.unwrap(), "{drag:?}");
    // And with the weight in the data they are told apart by these.
    let cases = exact(&loads(), &markers(3), |_| 1e-5);
    let fit = found(&cases, &wanted_free(), &QUICK);
    assert!(fit.verdict().iter().all(|words| !words.contains("flow.density and flow.cn")), "{:?}", fit.verdict());
}

fn wanted_free() -> Vec<Fitted> {
    wanted(&[Parameter::Young, Parameter::FlowDensity, Parameter::DragNormal])
}

#[test]
fn a_parameter_that_does_not_act_is_called_so() {
    let arms: Vec<_> = loads().into_iter().filter(|(name, _)| name == "pulled").collect();
    let cases = exact(&arms, &markers(4), |_| 1e-3);
    let fit = found(&cases, &wanted(&[Parameter::Young, Parameter::DragNormal]), &QUICK);
    assert!(
        matches!(fit.findings.as_slice(), [Finding::Silent { parameter: Unknown::Of(Parameter::DragNormal), .. }]),
        "{:?}",
        fit.findings
    );
    assert!(fit.verdict()[0].starts_with("the data hardly constrain flow.cn"), "{:?}", fit.verdict());
    assert_eq!(fit.estimates[1].value, 2.5, "it stays where it was");
    assert_eq!(fit.estimates[1].sd, Some(f64::INFINITY));
    assert!(fit.estimates[0].sd.unwrap().is_finite());
}

/// One number in twenty, drawn anew, is off by 20 to 60 mm.
fn spoilt(clean: &[Case], random: &mut Random) -> Vec<Case> {
    let mut out = clean.to_vec();
    let mut all: Vec<_> = out.iter_mut().flat_map(|case| &mut case.measurements).collect();
    let mut left = all.len() / 20;
    while left > 0 {
        let one = all.swap_remove(random.below(all.len()));
        one.value += (0.02 + 0.04 * random.uniform()) * if random.uniform() < 0.5 { -1.0 } else { 1.0 };
        left -= 1;
    }
    out
}

/// Least squares are moved by many standard deviations, what is linear from 1.345 of them on by about one where two of forty numbers are
/// off, and what is logarithmic by less than one.
#[test]
fn outliers_do_not_move_robust_estimates_by_more_than_their_standard_deviation() {
    let cases = exact(&loads(), &markers(5), |_| 1e-3);
    let wanted = wanted(&[Parameter::Young, Parameter::DragNormal]);
    let mut moves = [const { Vec::new() }; 3];
    for seed in 0..30 {
        let mut random = Random::new(1000 + seed);
        let clean = noisy(&cases, &mut random);
        let spoilt = spoilt(&clean, &mut random);
        for (moves, loss) in moves.iter_mut().zip(Loss::ALL) {
            let options = FitOptions { loss, ..QUICK };
            let [before, after] = [&clean, &spoilt].map(|data| found(data, &wanted, &options).estimates);
            for (before, after) in before.iter().zip(&after) {
                moves.push((after.value - before.value).abs() / before.sd.unwrap());
            }
        }
    }
    let [squares, huber, cauchy] = moves.map(|moves: Vec<f64>| {
        let mean = (moves.iter().map(|m| m * m).sum::<f64>() / moves.len() as f64).sqrt();
        (mean, moves.into_iter().fold(0.0, f64::max))
    });
    println!("root mean square and largest move in sd: squares {squares:?}, huber {huber:?}, cauchy {cauchy:?}");
    assert!(cauchy.1 < 1.0, "{cauchy:?}");
    assert!(huber.0 < 1.0 && huber.1 < 0.3 * squares.1, "{huber:?} {squares:?}");
    assert!(squares.0 > 3.0, "{squares:?}");
}

/// Shapes with errors of 1 % of the distance that each marker is displaced by, and of at least 0.1 mm.
#[test]
fn the_silicone_arm_is_recovered_from_its_shapes() {
    let parameters = [Parameter::Young, Parameter::DragNormal, Parameter::Density];
    let mut cases = exact(&loads(), &markers(6), |_| 1.0);
    for case in &mut cases {
        let moved: Vec<f64> = case
            .measurements
            .chunks(2)
            .map(|pair| {
                let s = pair[0].quantity.place().unwrap();
                (pair[0].value - s).hypot(pair[1].value)
            })
            .collect();
        for (pair, moved) in case.measurements.chunks_mut(2).zip(moved) {
            for one in pair {
                one.sd = (0.01 * moved).max(1e-4);
            }
        }
    }
    let cases = noisy(&cases, &mut Random::new(42));
    let mut wanted = wanted(&parameters);
    for (one, start) in wanted.iter_mut().zip([70e3, 1.2, 1150.0]) {
        one.start = start;
    }
    let fit = found(&cases, &wanted, &FitOptions::default());
    assert_eq!(fit.verdict(), ["the data determine all parameters"]);
    for (one, (truth, within)) in fit.estimates.iter().zip([(110e3, 0.01), (2.5, 0.02), (1080.0, 0.01)]) {
        println!("{} {} ± {} for {truth}", one.fitted.parameter, one.value, one.sd.unwrap());
        assert!((one.value / truth - 1.0).abs() < within, "{one:?}");
        assert!((one.value - truth).abs() < 3.0 * one.sd.unwrap(), "{one:?}");
    }
    assert_eq!(fit.left_out.len(), 4);
    for one in &fit.left_out {
        assert!(*one.predicted.as_ref().unwrap() < 3.0, "{one:?}");
    }
    assert!(fit.misfit().unwrap().starts_with("residuals agree"), "{:?}", fit.misfit());
}

/// Angles, tangents, strokes and base reactions say what positions do.
#[test]
fn all_kinds_of_measurements_count_together() {
    let mut quantities = vec![Quantity::X(0.245), Quantity::Angle(0.1), Quantity::Tangent(0.2), Quantity::Stroke(0)];
    quantities.extend([Quantity::BaseForce(0), Quantity::BaseForce(1), Quantity::BaseMoment]);
    let sd = |quantity: Quantity| match quantity.unit() {
        "m" => 5e-4,
        "rad" => 0.01,
        "N" => 1e-3,
        _ => 1e-4,
    };
    let cases = noisy(&exact(&loads(), &quantities, sd), &mut Random::new(5));
    let mut wanted = wanted(&[Parameter::Young, Parameter::DragNormal]);
    (wanted[0].start, wanted[1].start) = (90e3, 2.0);
    let fit = found(&cases, &wanted, &QUICK);
    for (one, truth) in fit.estimates.iter().zip([110e3, 2.5]) {
        assert!((one.value - truth).abs() < 4.0 * one.sd.unwrap(), "{one:?}");
    }
    assert_eq!(fit.residuals.len(), 28);
}

/// Half the silicone's stiffness folds the tip under this pull: the search has to come from there.
#[test]
fn trials_without_an_equilibrium_are_survived_and_named() {
    let mut arm = silicone();
    arm.cables[0].tension = 0.6;
    let cases = exact(&[("hard pull".to_owned(), arm)], &markers(4), |_| 1e-3);
    let mut wanted = wanted(&[Parameter::Young]);
    wanted[0].start = 400e3;
    let fit = found(&cases, &wanted, &QUICK);
    assert!((fit.estimates[0].value / 110e3 - 1.0).abs() < 1e-3, "{:?}", fit.estimates[0]);
    let refused = fit.no_answer.first().expect("a whole step from 400 kPa goes below what the tip can bear");
    assert!(refused.case == 0 && refused.trials > 0 && refused.at[0] < 110e3, "{refused:?}");
    wanted[0].start = 40e3;
    let error = fit_error(&cases, &wanted);
    assert!(
        error.starts_with("case hard pull has no equilibrium at the start values: a cable compresses its side"),
        "{error}"
    );
}

/// What is told how far the search is can end it, and gets what was found until there.
#[test]
fn a_search_is_ended_on_request() {
    let cases = exact(&loads(), &markers(2), |_| 1e-3);
    let mut wanted = wanted(&[Parameter::Young]);
    wanted[0].start = 200e3;
    let options = FitOptions { cross_validate: true, ..QUICK };
    let ended_at = |end: Progress| {
        let say = |step| {
            let ends = matches!((step, end), (Progress::Round(a, _), Progress::Round(b, _)) | (Progress::LeftOut(a, _), Progress::LeftOut(b, _)) if a == b);
            !ends
        };
        fit(&cases, &wanted, &options, say).unwrap()
    };
    let early = ended_at(Progress::Round(2, 0.0));
    assert!(!early.converged && early.rounds == 2 && early.left_out.is_empty());
    assert!((early.estimates[0].value - 110e3).abs() < 90e3, "nearer than the start");
    let late = ended_at(Progress::LeftOut(2, 0));
    assert!(late.converged && late.left_out.len() == 2 && late.left_out[1].case == 1);
}

fn fit_error(cases: &[Case], wanted: &[Fitted]) -> String {
    fit(cases, wanted, &QUICK, |_| true).unwrap_err().to_string()
}

#[test]
fn wrong_requests_are_refused() {
    let cases = exact(&loads()[..1], &markers(1), |_| 1e-3);
    let young = wanted(&[Parameter::Young])[0];
    assert_eq!(fit_error(&cases, &[]), "no parameter to fit was given");
    assert_eq!(fit_error(&[], &[young]), "there is no measured value");
    assert_eq!(fit_error(&cases, &[young, young]), "`material.young` is given twice");
    let within = Fitted { start: 1e5, bounds: [2e5, 3e5], ..young };
    assert_eq!(fit_error(&cases, &[within]), "`material.young`: expected a start within the bounds, found 100000");
    let prior = Fitted { prior: Some(Prior { mean: 1e5, sd: 0.0 }), ..young };
    assert!(fit_error(&cases, &[prior]).contains("a prior with a standard deviation above zero"));
    let mut wrong = cases.clone();
    wrong[0].measurements[0].sd = -1.0;
    assert!(fit_error(&wrong, &[young]).contains("case pulled, x at s = 245 mm"));
    wrong[0].measurements[0] = hydrostat_identify::Measurement::new(Quantity::X(0.3), 0.1, 1e-3);
    assert!(fit_error(&wrong, &[young]).contains("is beyond the arm, which is 245 mm long"));
    wrong[0].measurements[0].quantity = Quantity::Tension(0);
    assert!(fit_error(&wrong, &[young]).contains("is given in this case"));
    wrong[0].measurements[0].quantity = Quantity::Stroke(5);
    assert!(fit_error(&wrong, &[young]).contains("2 cables"));
}
