//! The tips of other programs beside those found here.

use std::collections::BTreeMap;

use hydrostat::{Arm, Options, Solver};
use hydrostat_files::{ArmFile, shipped};
use serde::Deserialize;

use crate::numbers::{fixed, size};
use crate::report::{Check, Row, Section, Table};

const COMMITTED: &str = include_str!("../data/tips.json");

/// What is wrong with a file of tips.
#[derive(Debug, thiserror::Error)]
#[error("not a file of tips as validation/peers/tips.py writes it: {0}")]
pub struct PeersError(#[from] serde_json::Error);

/// Tips as other programs have them, and where these numbers come from.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PeersFile {
    provenance: Provenance,
    tips: Vec<Entry>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Provenance {
    made_by: String,
    date: String,
    python: String,
    packages: BTreeMap<String, String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    program: String,
    arm: Named,
    /// Keys of the arm file with numbers in SI units.
    settings: BTreeMap<String, f64>,
    how: String,
    /// Over L.
    tip: [f64; 2],
    /// What the tip moved by from the next coarser mesh of the same program, over L.
    uncertainty: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Named {
    name: String,
    /// The arm's file, unless it ships with the program.
    toml: Option<String>,
}

impl PeersFile {
    /// The file of the repository.
    ///
    /// # Errors
    /// [`PeersError`], which a test keeps from happening.
    pub fn committed() -> Result<Self, PeersError> {
        Self::parse(COMMITTED)
    }

    /// A file that `validation/peers/tips.py` wrote.
    ///
    /// # Errors
    /// [`PeersError`] where it is not one.
    pub fn parse(text: &str) -> Result<Self, PeersError> {
        Ok(serde_json::from_str(text)?)
    }
}

impl Entry {
    fn arm(&self) -> Option<Arm> {
        let text = self.arm.toml.as_deref().or_else(|| shipped::get(&self.arm.name))?;
        let mut file = ArmFile::parse(text, &self.arm.name).ok()?;
        for (key, value) in &self.settings {
            file.set(key, &format!("{value:?}")).ok()?;
        }
        file.arm().ok()
    }

    /// The tip as found here, over L.
    fn own(&self) -> Option<[f64; 2]> {
        let arm = self.arm()?;
        let tip = Solver::new(&arm, Options::with_tol(1e-12)).and_then(|mut solver| solver.solve()).ok()?.tip();
        Some([tip.x / arm.length, tip.y / arm.length])
    }
}

pub(crate) fn section(file: &PeersFile) -> Section {
    let mut section = Section::new("peers", "Other programs on the same problems");
    section.text(
        "SciPy's solve_bvp gets the equations of the arm `paper`, written for it in Python; PyElastica relaxes a plain cantilever until it rests. Neither \
         fractions code with Hydrostat. How long each takes is the subject of validation/peers/README.md and docs/performance.md.",
    );
    let Provenance { made_by, date, python, packages } = &file.provenance;
    let versions: Vec<String> = packages.iter().map(|(name, version)| format!("{name} {version}")).collect();
    let mut table = Table::new(
        "Places of the tip",
        format!(
            "{made_by}, run on {date} with Python {python}, {}; not run again here. Allowed: three times what the program's own tip moved by when its \
             mesh was made twice as fine, and 1e-10.",
            versions.join(", ")
        ),
        &["program", "problem", "mesh", "its x/L", "its y/L", "x/L here", "y/L here"],
    );
    for entry in &file.tips {
        let [x, y] = entry.own().unwrap_or([f64::NAN; 2]);
        let off = (x - entry.tip[0]).hypot(y - entry.tip[1]);
        let settings: Vec<String> = entry.settings.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        let problem = [vec![entry.arm.name.clone()], settings].concat().join(", ");
        table.push(
            Row::new([
                entry.program.clone(),
                problem,
                entry.how.clone(),
                fixed(entry.tip[0], 11),
                fixed(entry.tip[1], 11),
                fixed(x, 11),
                fixed(y, 11),
            ])
            .checked(Check::within(off, 3.0 * entry.uncertainty + 1e-10)),
        );
    }
    if file.tips.is_empty() {
        table.push(Row::new(["no tips in the file"]).checked(Check::so(false)));
    }
    section.table(table);
    order(file, &mut section);
    section
}

/// PyElastica's errors against the number of its elements: they fall with the square.
fn order(file: &PeersFile, section: &mut Section) {
    let errors: Vec<(&str, f64)> = file
        .tips
        .iter()
        .filter(|entry| entry.program == "PyElastica")
        .filter_map(|entry| {
            let [x, y] = entry.own()?;
            Some((entry.how.as_str(), (x - entry.tip[0]).hypot(y - entry.tip[1])))
        })
        .collect();
    if errors.len() < 2 {
        return;
    }
    let list: Vec<String> = errors.iter().map(|(how, off)| format!("{} L with {how}", size(*off))).collect();
    section.text(format!(
        "The distance of PyElastica's tip falls with the square of its elements, as its method should: {}.",
        list.join(", ")
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_committed_file_is_read_and_its_arms_are_known() {
        let file = PeersFile::committed().unwrap();
        assert!(file.tips.len() >= 6);
        for entry in &file.tips {
            assert!(entry.arm().is_some(), "{entry:?}");
        }
        assert!(PeersFile::parse("{}").is_err());
    }
}
