//! What the source says about its figure, held against solved shapes.

use hydrostat_figures::Page;
use hydrostat_figures::source::{Claim, Finding, SPEED, Shown, Study, TIP_ANGLE};

use crate::numbers::fixed;
use crate::report::{Check, Row, Section, Table};
use crate::shipped;
use hydrostat::Arm;

/// The tension at which alpha(L) is [`TIP_ANGLE`], N (docs/model.md, section 10).
const TENSION: f64 = 86.24;

/// alpha in degrees at places of `paper` in 0, 0.5 and 1 m/s, to the digits of docs/model.md, section 10: tension (N), fraction of the length, values, half
/// of the last digit.
const ANGLES: [(f64, f64, [f64; 3], f64); 3] = [
    (40.0, 0.5, [1.91, 1.68, 1.14], 5e-3),
    (40.0, 1.0, [56.4004, 56.4004, 56.3988], 5e-5),
    (20.0, 0.0, [0.61, 0.72, 1.06], 5e-3),
];

/// The last claims are the source's conclusions, not about its figure.
const CONCLUSIONS: usize = 2;

/// The shapes of a shipped arm; where there are none, a check that failed says why.
fn solved(name: &str, shown: &Shown, section: &mut Section) -> Option<(Study, Arm)> {
    let why = match shipped::arm(name) {
        None => format!("the arm `{name}` could not be read"),
        Some(arm) => match Study::of(&arm, shown) {
            Ok(study) => return Some((study, arm)),
            Err(error) => error.to_string(),
        },
    };
    let mut table = Table::new(format!("The figure of `{name}`"), "the source", &["what", "here"]);
    table.push(Row::new(["solving its shapes".to_owned(), why]).checked(Check::so(false)));
    section.table(table);
    None
}

fn statements(title: &str, source: &str, claims: &[Claim], good: impl Fn(Finding) -> bool) -> Table {
    let mut table = Table::new(title, source, &["statement", "finding", "numbers"]);
    for Claim { statement, finding, evidence } in claims {
        table.push(
            Row::new([(*statement).to_owned(), finding.words().to_owned(), evidence.clone()])
                .checked(Check::so(good(*finding))),
        );
    }
    table
}

pub(crate) fn section() -> Section {
    let mut section = Section::new("claims", "What the source says about its figure");
    section.text(
        "The source, \"Quasi-static continuum model of octopus arm configuration under water\", publishes of Fig. 1 the stream, 0.5 m/s, and alpha(L) = 72.25 \
         deg at the highest tension. The parameters of the arm `paper` were found by trial; nothing here shows that they are the source's.",
    );
    let Some((study, arm)) = solved("paper", &Shown::default(), &mut section) else { return section };
    section.table(statements(
        "Statements of the source, on `paper`",
        "the source's text. What fails is a statement of which not even a part holds.",
        &study.claims,
        |finding| finding != Finding::DoesNotHold,
    ));
    let shown = Shown { at_highest: true, faster: vec![1.0] };
    if let Some((study, _)) = solved("paper-statements", &shown, &mut section) {
        let of_the_figure = &study.claims[..study.claims.len() - CONCLUSIONS];
        section.table(statements(
            "The same on `paper-statements`, at the highest tension",
            "the source's text. A set that validation/study searched for and whose price the arm's file names; what fails is a statement that does not hold \
             everywhere.",
            of_the_figure,
            |finding| finding == Finding::Holds,
        ));
    }

    let mut table = Table::new(
        "Numbers",
        "alpha(L) = 72.25 deg: the source. All others: docs/model.md, section 10, computed by the independent program of validation/reference and to the \
         digits printed there.",
        &["quantity", "here", "known"],
    );
    let angle = study.raised.last().map_or(f64::NAN, |c| c.tip().alpha.to_degrees());
    table.push(
        Row::new([format!("largest alpha(L) in {SPEED} m/s (deg)"), fixed(angle, 6), TIP_ANGLE.to_string()])
            .checked(Check::within(angle - TIP_ANGLE, 1e-5)),
    );
    let tension = study.highest_tension();
    table.push(
        Row::new(["tension there (N)".to_owned(), fixed(tension, 4), TENSION.to_string()])
            .checked(Check::within(tension - TENSION, 5e-3)),
    );
    for (tension, fraction, known, half) in ANGLES {
        for (speed, known) in [0.0, 0.5, 1.0].into_iter().zip(known) {
            let mut arm = arm.clone();
            arm.flow.speed = speed;
            for (k, cable) in arm.cables.iter_mut().enumerate() {
                cable.tension = if k == 0 { tension } else { 0.0 };
            }
            let alpha = arm.solve().map_or(f64::NAN, |c| c.at(fraction * arm.length).alpha.to_degrees());
            let decimals = if half < 1e-3 { 4 } else { 2 };
            table.push(
                Row::new([
                    format!("alpha at {fraction} L, {tension} N, {speed} m/s (deg)"),
                    fixed(alpha, decimals + 2),
                    fixed(known, decimals),
                ])
                // A digit that is rounded from a five is as good either way.
                .checked(Check::within(alpha - known, 1.02 * half)),
            );
        }
    }
    section.table(table);
    for figure in study.figures(&Page::default()) {
        let caption = match figure.name {
            "fig1a" => "The source's Fig. 1a: tension raised in 0.5 m/s.",
            "fig1b" => "Its Fig. 1b: one tension in ever faster streams.",
            _ => "Its Fig. 1c: the section's rotation alpha along the arm.",
        };
        section.figure(figure.name, caption, figure.scene);
    }
    section
}
