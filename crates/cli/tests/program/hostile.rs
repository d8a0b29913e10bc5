//! No input file of up to 1 MB makes the program panic, hang or take more than 500 MB: whatever it says, it says as an answer, a verdict or
//! a refusal that names the file.

use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::directory;

/// The largest input, bytes.
const LARGEST: usize = 1_000_000;

/// The most memory that may be resident, kB.
const MOST_MEMORY: u64 = 500_000;

/// When a run hangs: far beyond what any of these takes.
const HANGS: Duration = Duration::from_mins(2);

/// The most that a process has had resident so far, kB; `None` where the system does not tell.
fn peak_memory(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

/// Runs the program on a file of these bytes, which is `{}` among the arguments; its exit code and standard error.
fn run_on(name: &str, bytes: &[u8], args: &[&str]) -> (i32, String) {
    assert!(bytes.len() <= LARGEST, "{name}: {} bytes", bytes.len());
    let here = directory();
    std::fs::write(here.path().join("input"), bytes).unwrap();
    let file = |name: &str| std::fs::File::create(here.path().join(name)).unwrap();
    let args: Vec<&str> = args.iter().map(|arg| if *arg == "{}" { "input" } else { arg }).collect();
    let mut child = Command::new(env!("CARGO_BIN_EXE_hydrostat"))
        .args(&args)
        .current_dir(here.path())
        .stdin(Stdio::null())
        .stdout(file("out.txt"))
        .stderr(file("err.txt"))
        .spawn()
        .unwrap();
    let start = Instant::now();
    let mut memory = 0;
    let status = loop {
        memory = memory.max(peak_memory(child.id()).unwrap_or(0));
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if start.elapsed() > HANGS || memory > MOST_MEMORY {
            child.kill().unwrap();
            child.wait().unwrap();
            panic!("{name}, {args:?}: {memory} kB after {:?}", start.elapsed());
        }
        sleep(Duration::from_millis(2));
    };
    let said = std::fs::read_to_string(here.path().join("err.txt")).unwrap();
    let code = status.code().unwrap_or_else(|| panic!("{name}, {args:?}: {status}, {said}"));
    println!(
        "{name}, {args:?}: {code}, {} MB, {:.2} s: {:.160}",
        memory / 1000,
        start.elapsed().as_secs_f64(),
        said.trim()
    );
    assert!([0, 2, 3].contains(&code), "{name}, {args:?}: {code}, {said}");
    assert!(!said.contains("panicked"), "{name}, {args:?}: {said}");
    // All errors of an arm file are told, up to 50.
    let short = said.len() < 30_000 && said.lines().all(|line| line.len() < 5000);
    assert!(short, "{name}, {args:?}: {} bytes on standard error", said.len());
    (code, said)
}

const ARM: &str = "[arm]\nlength = 0.2\nradius = { base = 0.01, tip = 0.002 }\n[material]\nyoung = 1e5\n[flow]\nspeed = 0.1\ndirection = 60\n";

/// Bytes that follow from a seed (Marsaglia's xorshift).
fn bytes_of(mut seed: u64, count: usize) -> Vec<u8> {
    let mut next = || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        seed.to_le_bytes()[3]
    };
    (0..count).map(|_| next()).collect()
}

/// `text` again and again, as often as there is room for.
fn repeated(before: &str, text: &str, after: &str) -> Vec<u8> {
    let room = LARGEST - before.len() - after.len();
    format!("{before}{}{after}", text.repeat(room / text.len())).into_bytes()
}

/// A table of `points` with as many on the arm of 0.2 m, shifted so that two tables share no places.
fn table(points: usize, value: f64, shift: f64) -> String {
    let mut out = format!("[[0,{value}],");
    for i in 1..points - 1 {
        write!(out, "[{:.7},{value}],", 0.2 * (i as f64 + shift) / points as f64).unwrap();
    }
    write!(out, "[0.2,{value}]]").unwrap();
    out
}

/// Arm files that are none, with what is to be said of them.
fn broken_arms() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let mut not_text = repeated(ARM, "# a line\n", "");
    not_text[900_000] = 0xff;
    vec![
        ("bytes at random", bytes_of(1, LARGEST), "input:1"),
        ("invalid UTF-8 far down", not_text, "0xff"),
        ("zeros", vec![0; LARGEST], "input:1"),
        ("nothing", Vec::new(), "input:1"),
        ("arrays without end", repeated("x = ", "[", ""), "input:1"),
        ("nested arrays", [b"x = ".as_slice(), &b"[".repeat(400_000), &b"]".repeat(400_000)].concat(), "input:1"),
        ("nested tables", [repeated("x = ", "{a=", "").as_slice(), b""].concat(), "input:1"),
        ("a long dotted key", repeated("", "a.", "a = 1"), "input:1"),
        ("a long table head", repeated("[", "a.", "a]"), "input:1"),
        ("a long line", repeated("x = \"", "x", "\""), "input:1: x"),
        ("one number", repeated("[arm]\nlength = ", "9", ""), "arm.length"),
        ("a long unit", repeated("[arm]\nlength = \"1 ", "m", "\""), "arm.length"),
        (
            "unknown keys",
            (0..60_000).fold(String::new(), |t, i| t + &format!("key{i} = {i}\n")).into_bytes(),
            "input:1: key0",
        ),
        ("the same key", repeated("", "a = 1\n", ""), "input:2"),
        ("quotes without end", repeated("", "\"\"\"", ""), "input:"),
        ("10^4 cables", repeated(ARM, "[[cable]]\n", ""), "at most 100 cables"),
        (
            "a table of 60,000 points",
            format!("{ARM}[reference]\nmu = {}\n", table(60_000, 0.0, 0.0)).into_bytes(),
            "10000 points",
        ),
        (
            "tables at 40,000 places",
            format!(
                "{ARM}[reference]\nnu = {}\nmu = {}\neta = {}\n[distributed]\ncouple = {}\n",
                table(9999, 1.0, 0.1),
                table(9999, 0.0, 0.3),
                table(9999, 0.0, 0.5),
                table(9999, 0.0, 0.7)
            )
            .into_bytes(),
            "at most 10000 places",
        ),
        (
            "100 cables with tables",
            (0..100)
                .fold(ARM.to_owned(), |t, i| {
                    t + &format!("[[cable]]\noffset = {}\n", table(500, 0.001, f64::from(i) / 101.0))
                })
                .into_bytes(),
            "at most 769 places",
        ),
    ]
}

#[test]
fn arm_files_that_are_none_are_refused_with_a_line_an_error() {
    for (name, bytes, words) in broken_arms() {
        let (code, said) = run_on(name, &bytes, &["check", "{}"]);
        assert_eq!(code, 2, "{name}: {said}");
        assert!(said.contains(words), "{name}: {said}");
        let lines = || said.lines();
        assert!(lines().count() <= 50 && lines().all(|line| line.starts_with("error: input:")), "{name}: {said}");
    }
}

/// Arm files that are as large as they may be.
fn large_arms() -> Vec<(&'static str, Vec<u8>)> {
    let cables = |count: usize, more: &dyn Fn(usize) -> String| {
        (0..count)
            .fold(ARM.to_owned(), |text, i| text + &format!("[[cable]]\noffset = 0.001\ntension = 0.001\n{}", more(i)))
    };
    vec![
        ("a table of 10,000 points", format!("{ARM}[reference]\nmu = {}\n", table(10_000, 3.0, 0.0)).into_bytes()),
        ("100 cables", cables(100, &|_| String::new()).into_bytes()),
        ("100 cables with ends", cables(100, &|i| format!("end = {}\n", 0.009 * (i + 1) as f64)).into_bytes()),
        (
            "100 cables with tables",
            cables(100, &|_| format!("max_tension = 1\nend = 1\n# {}\n", "x".repeat(4000)))
                .replacen("offset = 0.001", &format!("offset = {}", table(760, 0.001, 0.2)), 1)
                .into_bytes(),
        ),
        ("cables with strokes", cables(24, &|_| "friction = 0.2\n".to_owned()).into_bytes()),
        ("a comment", repeated(ARM, "# a line\n", "")),
        ("a long name", repeated("name = \"", "long ", &format!("\"\n{ARM}"))),
    ]
}

#[test]
fn large_arm_files_are_solved_or_get_a_verdict() {
    for (name, bytes) in large_arms() {
        run_on(name, &bytes, &["solve", "{}"]);
    }
}

#[test]
#[ignore = "all commands on all large arms: minutes"]
fn slow_all_commands_bear_large_arm_files() {
    for (name, bytes) in large_arms() {
        for args in [
            &["check", "{}"][..],
            &["solve", "{}", "--format", "json", "--plot", "arm.svg"],
            &["solve", "{}", "--tol", "1e-12"],
            &["solve", "{}", "--plot", "arm.png"],
            &["sweep", "{}", "--vary", "flow.speed=0:0.2:3", "-o", "out.parquet"],
        ] {
            run_on(name, &bytes, args);
        }
    }
    for (name, bytes, _) in broken_arms() {
        for args in [&["solve", "{}"][..], &["sweep", "{}", "--vary", "flow.speed=0:0.2:3", "-o", "out.csv"]] {
            run_on(name, &bytes, args);
        }
    }
}

/// Files of measurements, with what is to be said of them.
fn broken_measurements() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let head = "case,cable[0].tension [N],s [mm],x [mm],y [mm]\n";
    vec![
        ("bytes at random", bytes_of(2, LARGEST), "UTF-8"),
        ("nothing", Vec::new(), "empty"),
        ("a long head", repeated("case", ",x [mm]", "\na,1\n"), "row 1"),
        ("a long cell", repeated(head, "x", "\n"), "row 2"),
        ("an open quote", repeated(&format!("{head}\""), "a,1\n", ""), "row 2"),
        ("commas", repeated(head, ",", "\n"), "no measured value"),
        ("the same place again and again", repeated(head, "a,,98,96.3,8.9\n", "a,,98,here,8.9\n"), "row 3"),
        ("comments", repeated("", "# none\n", ""), "empty"),
        ("ends of lines", repeated("", "\r", ""), "empty"),
        ("zeros", vec![0; LARGEST], "row 1"),
        ("many cases", numbered(|i| format!("c{i},0.1,98,96.3,8.9")), "at most 1000 load cases"),
        (
            "many places",
            numbered(|i| format!("a,,{:.4},1,1", 0.004 * f64::from(i + 1))),
            "at most 1000 measured numbers",
        ),
    ]
}

/// As many rows of measurements as there is room for.
fn numbered(row: impl Fn(u32) -> String) -> Vec<u8> {
    let mut text = "case,cable[0].tension [N],s [mm],x [mm],y [mm]\n".to_owned();
    for line in (0..).map(row) {
        if text.len() + line.len() + 1 > LARGEST {
            break;
        }
        text += &line;
        text.push('\n');
    }
    text.into_bytes()
}

#[test]
fn measurements_that_are_none_are_refused() {
    for (name, bytes, words) in broken_measurements() {
        let (code, said) =
            run_on(name, &bytes, &["identify", "silicone", "{}", "--fit", "young=80 kPa", "--sd", "1 mm"]);
        assert_eq!(code, 2, "{name}: {said}");
        assert!(said.contains(words), "{name}: {said}");
    }
}

#[test]
#[ignore = "fits of all that 1 MB can hold: minutes"]
fn slow_large_measurements_are_fitted() {
    let head = "case,cable[0].tension [N],s [mm],x [mm],y [mm]\n";
    let (mut cases, mut places) = (head.to_owned(), head.to_owned());
    for i in 0..1000 {
        writeln!(cases, "c{i},0.{:04},98,96.{:02},8.9", i * 3, i % 100).unwrap();
    }
    for i in 0..500 {
        let tension = if i == 0 { "0.1" } else { "" };
        writeln!(places, "a,{tension},{:.3},{:.3},1", 0.49 * f64::from(i), 0.49 * f64::from(i)).unwrap();
    }
    for arm in ["silicone", "octopus"] {
        for (name, text) in [("1000 cases", &cases), ("500 places", &places)] {
            run_on(name, text.as_bytes(), &["identify", arm, "{}", "--fit", "young=80 kPa", "--sd", "1 mm"]);
        }
    }
}

#[test]
fn paths_of_targets_that_are_none_are_refused() {
    let head = "x_mm,y_mm\n";
    for (name, bytes, words) in [
        ("bytes at random", bytes_of(3, LARGEST), "UTF-8"),
        ("nothing", Vec::new(), "input:1"),
        ("a long head", repeated("", "x_mm,", "\n"), "input:1"),
        ("a long cell", repeated(&format!("{head}1,"), "9", "\n"), "input:2"),
        ("commas", repeated(head, ",", "\n"), "input:2"),
        ("rows of which the last is none", repeated(head, "200,10\n", "here,10\n"), "here"),
        ("comments", repeated("", "# none\n", ""), "input:1"),
    ] {
        let (code, said) = run_on(name, &bytes, &["reach", "silicone", "--path", "{}"]);
        assert_eq!(code, 2, "{name}: {said}");
        assert!(said.contains("input") && said.contains(words), "{name}: {said}");
    }
}

/// Changes of the arms that are shipped, each from its own seed: what the parser lets through is solved.
fn changed_arms(count: u64) {
    let names = ["paper", "paper-statements", "silicone", "multi-bending", "octopus"];
    // Seeds that are neighbours share no arms.
    let first = hydrostat_fuzz::seed().wrapping_mul(0x2545_F491_4F6C_DD1D) >> 8;
    for seed in first..first + count {
        let name = names[usize::try_from(seed).unwrap() % names.len()];
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../files/arms").join(format!("{name}.toml"));
        let mut text = std::fs::read(path).unwrap();
        let dice = bytes_of(0x9e37_79b9_7f4a_7c15 ^ (seed + 1), 64);
        for change in dice.chunks_exact(4).take(1 + usize::from(dice[63] % 5)) {
            let at = (usize::from(change[0]) * 256 + usize::from(change[1])) % text.len();
            match change[2] % 3 {
                0 if text[at].is_ascii_digit() => text[at] = b'0' + change[3] % 10,
                0 | 1 => text
                    .splice(at..at, b"0123456789e-.\n\"["[usize::from(change[3] % 16)..][..1].iter().copied())
                    .for_each(drop),
                _ => text.drain(at..(at + 3).min(text.len())).for_each(drop),
            }
        }
        run_on(&format!("{name}, seed {seed}"), &text, &["solve", "{}"]);
    }
}

#[test]
fn changed_arm_files_are_solved_or_refused() {
    changed_arms(40);
}

#[test]
#[ignore = "thousands of runs of the program"]
fn slow_many_changed_arm_files_are_solved_or_refused() {
    changed_arms(4000);
}

/// A grid of more rows than there are numbers for, an output that no disk holds.
#[test]
fn sweeps_of_any_size_are_refused_or_begun_in_little_memory() {
    for vary in [
        &["--vary", "flow.speed=0:0.2:99999999999999999999"][..],
        &[
            "--vary",
            "flow.speed=0:0.2:1000000000",
            "--vary",
            "flow.direction=0:90:1000000000",
            "--vary",
            "cable[0].tension=0:1:1000000000",
        ],
    ] {
        let args = [&["sweep", "silicone", "-o", "out.csv"], vary].concat();
        let (code, said) = run_on("a sweep", b"", &args);
        assert_eq!(code, 2, "{said}");
    }
}
