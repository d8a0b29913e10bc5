//! `docs/model.md` points at functions that are there.

use std::path::Path;

/// Whether a function of this name, which may carry its type, is in the source.
fn defines(source: &str, name: &str) -> bool {
    let plain = name.rsplit("::").next().unwrap();
    source.contains(&format!("fn {plain}(")) || source.contains(&format!("fn {plain}<"))
}

/// `text` without what stands in parentheses.
fn without_asides(text: &str) -> String {
    let mut depth = 0;
    let outside = text.chars().filter(|c| {
        depth += i32::from(*c == '(') - i32::from(*c == ')');
        depth == 0 && *c != ')'
    });
    outside.collect()
}

/// What section 12 says of the tip of `paper`.
#[test]
fn the_tip_of_paper_was_described_at_another_tension() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("../../docs/model.md")).unwrap();
    let tip = |tension: f64| {
        let text = hydrostat_files::shipped::get("paper").unwrap();
        let mut arm = hydrostat_files::ArmFile::parse(text, "paper").unwrap().arm().unwrap();
        arm.set_tensions(&[tension, 0.0]).unwrap();
        let shape = arm.solve().unwrap();
        shape.at(arm.length)
    };
    let [slack, tight] = [40.0, 86.24].map(tip);
    for words in [
        format!("the tip of `paper` is at {:.3} at 40 N, at {:.3} at 86.24 N", slack.nu, tight.nu),
        format!("nu beta^2 = beta, {:.1} and {:.1} at that tip", slack.beta, tight.beta),
    ] {
        assert!(page.contains(&words), "{words}");
    }
}

#[test]
fn the_table_of_equations_names_functions_that_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("../../docs/model.md")).unwrap();
    let (_, table) = page.split_once("## 13. ").unwrap();
    let mut seen = 0;
    for row in table.lines().filter(|line| line.contains(".rs`")) {
        let functions = without_asides(row.split(" | ").last().unwrap());
        let mut source = None;
        for name in functions.split('`').skip(1).step_by(2) {
            if Path::new(name).extension().is_some() {
                source = Some(std::fs::read_to_string(root.join("src").join(name)).expect(name));
            } else {
                assert!(defines(source.as_ref().expect(row), name), "{name} in {row}");
                seen += 1;
            }
        }
    }
    assert!(seen >= 30, "{seen}");
}

/// The source files under a folder.
fn sources(folder: &Path, out: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            out.push(path);
        }
    }
}

#[test]
fn comments_keep_to_120_columns() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = Vec::new();
    for folder in ["src", "tests"] {
        sources(&root.join(folder), &mut files);
    }
    assert!(files.len() > 90, "{}", files.len());
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        for (index, line) in text.lines().enumerate().filter(|(_, line)| line.trim_start().starts_with("//")) {
            let columns = line.chars().count();
            assert!(columns <= 120, "{}:{}: {columns} columns", file.display(), index + 1);
        }
    }
}
