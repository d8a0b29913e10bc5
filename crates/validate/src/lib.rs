//! The evidence for Hydrostat: every check that supports a claim of it, run again, and written as one report.
//!
//! [`run`] solves the problems whose answers are known, in the plane and in space, measures orders of convergence, holds error estimates against true
//! errors, adds up the loads of whole arms and of their parts, solves a grid of arms, remakes what the source says about
//! its figure, compares the readings of the source, follows a flexible blade into fast streams, fits a built arm to measured poses, and puts the numbers of other
//! programs beside its own. What comes out is a [`Report`]: sections of tables, each of which says where its reference
//! numbers come from, and figures. A row of a table may be a check ([`Check`]); a report holds if all of them do.
//!
//! ```
//! use hydrostat_validate::{Check, Report, Row, Section, Table, html};
//!
//! let mut table = Table::new("An angle", "a closed form", &["case", "here", "known"]);
//! table.push(Row::new(["a right angle", "1.5707963", "1.5707963"]).checked(Check::within(2e-9, 1e-8)));
//! let mut section = Section::new("angles", "Angles");
//! section.table(table);
//! let report = Report { title: "An example".to_owned(), about: Vec::new(), sections: vec![section] };
//! assert!(report.holds() && report.checks() == 1);
//! assert!(html(&report).contains("a closed form"));
//! ```

pub mod balance;
mod built;
mod claims;
pub mod convergence;
pub mod estimate;
mod exact;
pub mod grid;
mod html;
mod in_space;
mod loads;
mod markdown;
mod numbers;
mod peers;
pub mod readings;
mod reconfiguration;
mod report;
mod scope;
mod shipped;

use hydrostat::cases;

pub use html::html;
pub use markdown::{Markdown, markdown};
pub use peers::{PeersError, PeersFile};
pub use report::{Block, Check, Figure, Report, Row, Section, Table};
pub use scope::{Listener, Scope};

pub use crate::exact::section as exact_section;

/// Runs every check. What cannot be solved is a check that does not hold, never an error.
pub fn run(scope: Scope, peers: &PeersFile, listener: &dyn Listener) -> Report {
    type Part<'a> = (&'a str, Box<dyn Fn() -> Section + 'a>);
    let parts: Vec<Part<'_>> = vec![
        ("exact answers", Box::new(|| exact::section(&cases::all()))),
        ("arms in space", Box::new(|| in_space::section(&cases::all()))),
        ("orders of convergence", Box::new(convergence::section)),
        ("error estimates", Box::new(move || estimate::section(scope, listener))),
        ("balances", Box::new(move || balance::section(scope, listener))),
        ("a grid of arms", Box::new(move || grid::section(scope, listener))),
        ("the source's claims", Box::new(claims::section)),
        ("readings of the source", Box::new(move || readings::section(scope))),
        ("a blade in fast streams", Box::new(move || reconfiguration::section(scope))),
        ("a built arm", Box::new(built::section)),
        ("other programs", Box::new(|| peers::section(peers))),
    ];
    let of = parts.len();
    let sections = parts.into_iter().enumerate().map(|(k, (title, make))| {
        listener.begins(k + 1, of, title);
        make()
    });
    let about = vec![
        format!(
            "Hydrostat {}, {}. Every number of this page was computed in this run, but for reference numbers, whose origin each table states.",
            env!("CARGO_PKG_VERSION"),
            match scope {
                Scope::Whole => "the whole run",
                Scope::Quick => "the quick run: the same checks on fewer cases",
            }
        ),
        "A check compares a deviation with what is allowed; a row that does not keep to it says FAILS, and the program then ends \
         with status 1."
            .to_owned(),
    ];
    Report { title: "Hydrostat: validation".to_owned(), about, sections: sections.collect() }
}

/// The Rust of the guide, compiled and run as documentation is.
#[cfg(doctest)]
mod guide {
    macro_rules! chapter {
        ($name:ident) => {
            #[doc = include_str!(concat!("../../../guide/src/", stringify!($name), ".md"))]
            mod $name {}
        };
    }

    chapter!(install);
    #[doc = include_str!("../../../guide/src/first-solve.md")]
    mod first_solve {}
    chapter!(model);
    chapter!(verdicts);
    chapter!(sweeps);
    chapter!(inverse);
    chapter!(evidence);
}
