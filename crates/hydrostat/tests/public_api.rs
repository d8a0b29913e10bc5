//! The public interface of the library crates, as text that changes with it: `public-api.txt` of each.
//!
//! Written anew by `HYDROSTAT_PUBLIC_API=write cargo test -p hydrostat --test public_api`.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The format that public-api 0.52.0 reads, which Rust 1.95 writes.
const READ: u64 = 57;

const CRATES: [(&str, &str); 4] = [
    ("hydrostat-bvp", "bvp"),
    ("hydrostat", "hydrostat"),
    ("hydrostat-identify", "identify"),
    ("hydrostat-files", "files"),
];

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// What rustdoc says of a crate. The format is not stable yet: the compiler is told to write it all the same.
fn documented(name: &str, target: &Path) -> PathBuf {
    let output = Command::new(env!("CARGO"))
        .current_dir(workspace())
        .env("RUSTC_BOOTSTRAP", "1")
        .env_remove("RUSTDOCFLAGS")
        .args(["rustdoc", "--quiet", "--lib", "--package", name, "--target-dir"])
        .arg(target)
        .args(["--", "-Z", "unstable-options", "--output-format", "json", "--cap-lints", "allow"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    target.join("doc").join(name.replace('-', "_")).with_extension("json")
}

/// The version of that format.
fn format_of(json: &str) -> Option<u64> {
    serde_json::from_str::<serde_json::Value>(json).ok()?.get("format_version")?.as_u64()
}

#[test]
fn public_interfaces_are_those_written_down() {
    // Beside the tests' own files, which a cargo around this one may have locked.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("public-api");
    let mut changed = Vec::new();
    for (name, folder) in CRATES {
        let json = documented(name, &target);
        let text = std::fs::read_to_string(&json).unwrap();
        if format_of(&text) != Some(READ) {
            println!("not compared: rustdoc writes its format {:?}, public-api reads {READ}", format_of(&text));
            return;
        }
        let api = public_api::Builder::from_rustdoc_json(&json)
            .omit_blanket_impls(true)
            .omit_auto_trait_impls(true)
            .omit_auto_derived_impls(true)
            .build()
            .unwrap();
        let found = api.to_string();
        let path = workspace().join("crates").join(folder).join("public-api.txt");
        if std::env::var("HYDROSTAT_PUBLIC_API").is_ok_and(|value| value == "write") {
            std::fs::write(&path, &found).unwrap();
        }
        let known = std::fs::read_to_string(&path).unwrap_or_default();
        let (found, known): (Vec<&str>, Vec<&str>) = (found.lines().collect(), known.lines().collect());
        changed.extend(known.iter().filter(|line| !found.contains(line)).map(|line| format!("- {line}")));
        changed.extend(found.iter().filter(|line| !known.contains(line)).map(|line| format!("+ {line}")));
    }
    assert!(
        changed.is_empty(),
        "public interfaces changed; where that is meant, write them anew:\n{}",
        changed.join("\n")
    );
}
