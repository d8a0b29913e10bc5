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
