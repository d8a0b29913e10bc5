//! Arms solved by an independent program (`validation/reference`), compared number by number.

use hydrostat_validate::estimate::{Compared, Reference, compare, ratios, references, references_with_weight};

/// What became of each, how many are answered, and how far they are off at most; all are met.
fn compared(all: &[Reference]) -> (Vec<Compared>, usize, f64) {
    let compared: Vec<Compared> = all.iter().map(compare).collect();
    let wrong: Vec<String> = all
        .iter()
        .zip(&compared)
        .filter(|(_, compared)| !compared.holds())
        .map(|(reference, compared)| format!("{}: {compared:?}", reference.name))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let mut offs: Vec<f64> = compared
        .iter()
        .filter_map(|one| if let Compared::Solved { off, .. } = one { Some(*off) } else { None })
        .collect();
    offs.sort_by(f64::total_cmp);
    println!(
        "{} of {}: off by {:e} in the median, {:e} at most",
        offs.len(),
        all.len(),
        offs[offs.len() / 2],
        offs[offs.len() - 1]
    );
    (compared, offs.len(), offs[offs.len() - 1])
}

/// Arms whose cables, stream and weight act by the default reading of the water that is displaced. The same arms have other shapes by the
/// other reading, in `cases.json`.
#[test]
fn arms_with_weight_agree_with_an_independent_solver() {
    let all = references_with_weight().expect("a file of references");
    let (_, count, largest) = compared(&all);
    assert_eq!((all.len(), count), (64, 64));
    assert!(largest < 2e-8, "{largest:e}");
}

#[test]
fn configurations_agree_with_an_independent_solver() {
    let all = references().expect("a file of references");
    assert_eq!(all.len(), 160);
    let (compared, count, largest) = compared(&all);
    assert!(count == 156 && largest < 2e-8, "{count} answered, off by {largest:e} at most");

    // The estimate: true errors at most 3 estimates in 95 % of cases and never more than 10, and
    // the median estimate at most 30 true errors.
    let ratios = ratios(&compared);
    let at = |percent: usize| ratios[(ratios.len() - 1) * percent / 100];
    println!("true error over estimate: median {:.2}, 95 % {:.2}, worst {:?}", at(50), at(95), at(100));
    assert!(ratios.len() > 120);
    assert!(at(95) <= 3.0 && at(100) <= 10.0 && at(50) >= 1.0 / 30.0, "{:?}", &ratios[ratios.len() - 8..]);
}
