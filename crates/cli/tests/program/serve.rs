//! `hydrostat serve` from outside: its answers are those of the other commands, and it bears many at once.

use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use super::{hydrostat, refused, solved};

/// A viewer of its own on a free port, which ends with the test.
struct Viewer {
    program: Child,
    host: String,
}

impl Drop for Viewer {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

impl Viewer {
    fn of(arguments: &[&str]) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_hydrostat"))
            .args(["serve", "--port", "0"])
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(program.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let host = line.trim().strip_prefix("http://").and_then(|rest| rest.strip_suffix('/')).unwrap().to_owned();
        Self { program, host }
    }

    fn connect(&self) -> Connection {
        let stream = TcpStream::connect(&self.host).unwrap();
        stream.set_read_timeout(Some(Duration::from_mins(1))).unwrap();
        stream.set_nodelay(true).unwrap();
        Connection { host: self.host.clone(), stream: BufReader::new(stream) }
    }

    fn post(&self, path: &str, body: &str) -> Reply {
        self.connect().post(path, body)
    }

    /// Resident memory, KiB.
    fn memory(&self) -> Option<u64> {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.program.id())).ok()?;
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
        line.split_whitespace().next()?.parse().ok()
    }
}

/// A connection that is kept open.
struct Connection {
    host: String,
    stream: BufReader<TcpStream>,
}

#[derive(Debug)]
struct Reply {
    status: u16,
    headers: Vec<(String, String)>,
    body: String,
}

impl Reply {
    fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.body).unwrap()
    }

    fn header(&self, name: &str) -> Option<&str> {
        self.headers.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str())
    }
}

impl Connection {
    fn post(&mut self, path: &str, body: &str) -> Reply {
        self.send("POST", path, &[("Content-Type", "application/json")], body)
    }

    fn send(&mut self, method: &str, path: &str, headers: &[(&str, &str)], body: &str) -> Reply {
        let mut text = format!("{method} {path} HTTP/1.1\r\nContent-Length: {}\r\n", body.len());
        if !headers.iter().any(|(name, _)| *name == "Host") {
            let _ = write!(text, "Host: {}\r\n", self.host);
        }
        for (name, value) in headers {
            let _ = write!(text, "{name}: {value}\r\n");
        }
        text.push_str("\r\n");
        text.push_str(body);
        self.stream.get_mut().write_all(text.as_bytes()).unwrap();
        self.receive()
    }

    fn receive(&mut self) -> Reply {
        let mut line = String::new();
        self.stream.read_line(&mut line).unwrap();
        let status = line.split(' ').nth(1).unwrap_or_default().parse().unwrap();
        let mut headers = Vec::new();
        loop {
            line.clear();
            self.stream.read_line(&mut line).unwrap();
            match line.trim_end().split_once(": ") {
                Some((name, value)) => headers.push((name.to_ascii_lowercase(), value.to_owned())),
                None => break,
            }
        }
        let length = headers.iter().find(|(name, _)| name == "content-length").map_or(0, |(_, v)| v.parse().unwrap());
        let mut body = vec![0; length];
        self.stream.read_exact(&mut body).unwrap();
        Reply { status, headers, body: String::from_utf8_lossy(&body).into_owned() }
    }
}

/// What a command prints.
fn printed(arguments: &[&str]) -> String {
    hydrostat(arguments).out.trim_end().to_owned()
}

#[test]
fn answers_are_those_of_the_commands_to_the_last_digit() {
    let viewer = Viewer::of(&[]);
    for (path, body, arguments) in [
        ("solve", r#"{"arm": "paper"}"#, vec!["solve", "paper", "--format", "json"]),
        (
            "solve",
            r#"{"arm": "silicone", "set": {"cable[0].tension": "300 mN", "flow.speed": 0.1}, "stations": 7, "tol": 1e-7}"#,
            vec![
                "solve",
                "silicone",
                "--set",
                "cable[0].tension=0.3",
                "--flow-speed",
                "0.1",
                "--stations",
                "7",
                "--tol",
                "1e-7",
                "--format",
                "json",
            ],
        ),
        (
            "solve",
            r#"{"arm": "octopus", "stations": 5, "format": "csv"}"#,
            vec!["solve", "octopus", "--stations", "5", "--format", "csv"],
        ),
        (
            "solve",
            r#"{"arm": "silicone", "set": {"cable[0].tension": 1.5}}"#,
            vec!["solve", "silicone", "--tension", "1.5,0", "--format", "json"],
        ),
        (
            "path",
            r#"{"arm": "silicone", "vary": "cable[0].tension=100:500 mN"}"#,
            vec!["path", "silicone", "--vary", "cable[0].tension=100:500 mN", "--format", "json"],
        ),
        (
            "equilibria",
            r#"{"arm": "silicone", "set": {"flow.speed": 0.2, "flow.direction": 180}}"#,
            vec!["equilibria", "silicone", "--flow-speed", "0.2", "--set", "flow.direction=180", "--format", "json"],
        ),
        (
            "reach",
            r#"{"arm": "silicone", "target": ["182 mm", 0.078], "max_tension": 0.6}"#,
            vec!["reach", "silicone", "--target", "0.182,0.078", "--max-tension", "0.6", "--format", "json"],
        ),
        (
            "reach",
            r#"{"arm": "silicone", "target": [0.14, 0.015], "station": "150 mm"}"#,
            vec!["reach", "silicone", "--target", "0.14,0.015", "--station", "0.15", "--format", "json"],
        ),
        (
            "reach",
            r#"{"arm": "silicone", "target": [0.182, 0.078], "by": "strokes", "max_stroke": "12 mm"}"#,
            vec![
                "reach",
                "silicone",
                "--target",
                "0.182,0.078",
                "--by",
                "strokes",
                "--max-stroke",
                "12 mm",
                "--format",
                "json",
            ],
        ),
    ] {
        let reply = viewer.post(&format!("/api/{path}"), body);
        assert_eq!(reply.status, 200, "{body}: {}", reply.body);
        assert_eq!(reply.body.trim_end(), printed(&arguments), "{body}");
    }
}

#[test]
fn drawings_are_those_of_the_program() {
    let viewer = Viewer::of(&[]);
    let directory = super::directory();
    let file = directory.path().join("arm.svg");
    solved(&["solve", "silicone", "--tension", "0.3,0", "--plot", file.to_str().unwrap()]);
    let body = r#"{"arm": "silicone", "set": {"cable[0].tension": 0.3}, "format": "svg"}"#;
    let reply = viewer.post("/api/solve", body);
    assert_eq!(reply.header("content-type"), Some("image/svg+xml"));
    assert_eq!(reply.body, std::fs::read_to_string(file).unwrap());
    let png = viewer.post("/api/solve", r#"{"arm": "paper", "format": "png"}"#);
    assert_eq!((png.status, png.header("content-type")), (200, Some("image/png")));
    assert!(png.body.contains("PNG"));
}

#[test]
fn a_file_is_given_to_the_page_and_no_other_is_read() {
    let directory = super::directory();
    let file = directory.path().join("mine.toml");
    let text = "name = \"mine\"\n[arm]\nlength = 0.2\nradius = 0.01\n[material]\nyoung = 1e5\n";
    std::fs::write(&file, text).unwrap();
    let viewer = Viewer::of(&[file.to_str().unwrap()]);
    let arms = viewer.connect().send("GET", "/api/arms", &[], "").json();
    assert_eq!(arms["given"]["toml"], text);
    assert_eq!(arms["given"]["name"], "mine.toml");
    let named = format!(r#"{{"arm": {:?}}}"#, file.to_str().unwrap());
    let reply = viewer.post("/api/solve", &named);
    assert_eq!((reply.status, &reply.json()["error"]["field"]), (400, &serde_json::json!("arm")));
    for path in ["/../Cargo.toml", "/%2e%2e/Cargo.toml", "/style.css/../../Cargo.toml", "//etc/passwd"] {
        assert_eq!(viewer.connect().send("GET", path, &[], "").status, 404, "{path}");
    }
}

#[test]
fn foreign_pages_and_names_are_refused() {
    let viewer = Viewer::of(&["--allow-host", "arm.example"]);
    let get = |headers: &[(&str, &str)]| viewer.connect().send("GET", "/api/arms", headers, "");
    assert_eq!(get(&[]).status, 200);
    assert_eq!(get(&[("Host", "arm.example")]).status, 200);
    assert_eq!(get(&[("Host", "rebound.example")]).status, 403);
    assert_eq!(get(&[("Origin", "http://elsewhere.example")]).status, 403);
    let own = format!("http://{}", viewer.host);
    let reply = get(&[("Origin", &own)]);
    assert_eq!(reply.status, 200);
    let policy = reply.header("content-security-policy").unwrap();
    assert!(policy.contains("script-src 'self'") && !policy.contains("unsafe"), "{policy}");
    assert_eq!(reply.header("x-content-type-options"), Some("nosniff"));
    let form = [("Content-Type", "text/plain")];
    assert_eq!(viewer.connect().send("POST", "/api/solve", &form, r#"{"arm": "paper"}"#).status, 415);
    let session = viewer.connect().send("GET", "/api/session", &[("Origin", "http://elsewhere.example")], "");
    assert_eq!(session.status, 403);
}

#[test]
fn a_body_that_is_too_large_is_refused() {
    let viewer = Viewer::of(&[]);
    let body = format!(r#"{{"arm": {{"toml": "{}"}}}}"#, "#".repeat(1 << 20));
    let reply = viewer.post("/api/solve", &body);
    assert_eq!((reply.status, &reply.json()["error"]["field"]), (413, &serde_json::json!("body")));
}

#[test]
fn a_port_that_is_taken_is_said() {
    let viewer = Viewer::of(&[]);
    let port = viewer.host.rsplit(':').next().unwrap();
    assert!(refused(&["serve", "--port", port]).contains("cannot be listened on"));
    assert!(refused(&["serve", "nowhere.toml"]).contains("nowhere.toml"));
}

/// So many clients, each with so many requests that alternate between arms and kinds; the memory (KiB) after a tenth of them and
/// at the end.
fn load(clients: usize, requests: usize) -> Option<[u64; 2]> {
    let viewer = Viewer::of(&[]);
    let round = |requests: usize| {
        std::thread::scope(|scope| {
            for client in 0..clients {
                let viewer = &viewer;
                scope.spawn(move || {
                    let mut connection = viewer.connect();
                    for request in 0..requests {
                        let tension = 0.01 * f64::from(u32::try_from((7 * client + request) % 60).unwrap());
                        let body = format!(
                            r#"{{"arm": "silicone", "set": {{"cable[0].tension": {tension}, "flow.speed": 0.1}}, "stations": 101}}"#
                        );
                        let reply = connection.post("/api/solve", &body);
                        assert_eq!(reply.status, 200, "{body}: {}", reply.body);
                        assert!(reply.body.starts_with(r#"{"schema":1"#) && reply.body.contains(r#""converged":true"#));
                    }
                });
            }
        });
        viewer.memory()
    };
    let tenth = requests.div_ceil(10);
    let early = round(tenth)?;
    Some([early, round(requests - tenth)?])
}

#[test]
fn thirty_clients_at_once_are_all_answered() {
    load(30, 6);
}

#[test]
#[ignore = "10 000 requests take minutes on a busy machine"]
fn slow_ten_thousand_requests_leave_the_memory_as_it_was() {
    let Some([early, late]) = load(30, 334) else { return };
    println!("resident after 1 000 requests {early} KiB, after 10 000 {late} KiB");
    assert!(late < early + early / 4 + 4096, "{early} KiB, then {late} KiB");
}
