//! The report of all checks.

use super::{directory, files, hydrostat_in, json, refused};

const TIPS: &str = include_str!("../../../validate/data/tips.json");

/// The quick run, with one number of another program changed in its fourth digit: that check fails and no other, the report says so, and the
/// program ends with status 1.
#[test]
fn a_wrong_number_fails_one_check_and_the_program() {
    let directory = directory();
    let mut tips = json(TIPS);
    let tip = &mut tips["tips"][0]["tip"][0];
    *tip = (tip.as_f64().unwrap() + 1e-4).into();
    std::fs::write(directory.path().join("tips.json"), tips.to_string()).unwrap();
    let run = hydrostat_in(directory.path(), &["validate", "--quick", "--peers", "tips.json", "-o", "out/report"]);
    assert_eq!(run.code, 1, "{}{}", run.out, run.err);
    assert!(run.err.starts_with("error: 1 of "), "{}{}", run.out, run.err);
    let report = directory.path().join("out/report");
    assert_eq!(files(&report), ["figures", "index.html", "report.md"]);

    let page = std::fs::read_to_string(report.join("index.html")).unwrap();
    assert_eq!(page.matches(">FAILS<").count(), 1);
    assert!(page.matches(">holds<").count() > 200);
    for words in
        ["Exact answers", "Orders of convergence", "Balances", "limit point", "72.25", "Gosselin", "PyElastica", "<svg"]
    {
        assert!(page.contains(words), "{words}");
    }
    // Nothing is loaded from elsewhere: the one address in it is the name space of its drawings.
    assert!(!page.contains("<script") && !page.contains("<link"));
    assert_eq!(page.matches("http").count(), page.matches("xmlns=\"http://www.w3.org/2000/svg\"").count());

    let text = std::fs::read_to_string(report.join("report.md")).unwrap();
    assert_eq!(text.matches("**FAILS**").count(), 1);
    let shown: Vec<&str> = text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert_eq!(shown.len(), page.matches("<figure>").count());
    for figure in shown {
        let svg = std::fs::read_to_string(report.join(figure)).unwrap();
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n"), "{figure}");
    }
}

#[test]
fn numbers_of_other_programs_have_to_be_some() {
    let message = refused(&["validate", "--quick", "--peers", "nowhere.json"]);
    assert!(message.contains("--peers nowhere.json"), "{message}");
    let directory = directory();
    std::fs::write(directory.path().join("tips.json"), "{}").unwrap();
    let run = hydrostat_in(directory.path(), &["validate", "--quick", "--peers", "tips.json"]);
    assert_eq!(run.code, 2);
    assert!(run.err.contains("validation/peers/tips.py"), "{}", run.err);
    assert_eq!(files(directory.path()), ["tips.json"]);
}
