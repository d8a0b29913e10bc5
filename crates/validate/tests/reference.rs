//! Arms solved by an independent program (`validation/reference`), compared number by number.

use hydrostat_validate::estimate::{Compared, compare, ratios, references};

#[test]
fn configurations_agree_with_an_independent_solver() {
    let all = references().expect("a file of references");
    assert_eq!(all.len(), 163);
    let compared: Vec<Compared> = all.iter().map(compare).collect();
    let wrong: Vec<String> = all
        .iter()
        .zip(&compared)
        .filter(|(_, compared)| !compared.holds())
        .map(|(reference, compared)| format!("{}: {compared:?}", reference.name))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let off = compared.iter().filter_map(|one| match one {
        Compared::Solved { off, .. } => Some(*off),
        _ => None,
    });
    let (count, largest) = off.fold((0, 0.0_f64), |(count, largest), off| (count + 1, largest.max(off)));
    assert!(count == 159 && largest < 2e-8, "{count} answered, off by {largest:e} at most");

    // The estimate: true errors at most 3 estimates in 95 % of cases and never more than 10, and
    // the median estimate at most 30 true errors.
    let ratios = ratios(&compared);
    let at = |percent: usize| ratios[(ratios.len() - 1) * percent / 100];
    println!("true error over estimate: median {:.2}, 95 % {:.2}, worst {:?}", at(50), at(95), at(100));
    assert!(ratios.len() > 120);
    assert!(at(95) <= 3.0 && at(100) <= 10.0 && at(50) >= 1.0 / 30.0, "{:?}", &ratios[ratios.len() - 8..]);
}
