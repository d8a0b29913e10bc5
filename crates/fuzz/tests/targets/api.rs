//! Bodies of requests to the viewer's HTTP interface: an answer in time, and never one that says that the server failed.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::LazyLock;
use std::time::Duration;

use hydrostat_fuzz::{fuzz, mutations_of};
use hydrostat_serve::{Options, Server};
use proptest::sample::select;

/// The server of this test, on a port of its own at loopback.
static SERVER: LazyLock<SocketAddr> = LazyLock::new(|| {
    let (send, receive) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let server = Server::bind(Options { port: 0, ..Options::default() }).await.unwrap();
            send.send(server.address()).unwrap();
            server.run().await.unwrap();
        });
    });
    receive.recv().unwrap()
});

/// Longer than the server takes for any request, its waiting included.
const PATIENCE: Duration = Duration::from_mins(1);

/// Status and body of the answer.
fn post(path: &str, body: &[u8]) -> std::io::Result<(u16, String)> {
    let mut stream = TcpStream::connect(*SERVER)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    let head = format!(
        "POST {path} HTTP/1.1\r\nHost: {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        *SERVER,
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    // A body that is too large is refused before it is read.
    let _ = stream.write_all(body);
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer)?;
    let text = String::from_utf8_lossy(&answer).into_owned();
    let (head, body) = text.split_once("\r\n\r\n").unwrap_or((&text, ""));
    let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0);
    Ok((status, body.to_owned()))
}

#[test]
fn api() {
    let bodies = [
        r#"{"arm": "silicone", "set": {"flow.speed": 0.1, "cable[0].tension": "0.3 N"}, "tol": 1e-6, "stations": 5}"#,
        r#"{"arm": {"toml": "[arm]\nlength = 0.2\nradius = {base = 0.01, tip = 0.002}\n[material]\nyoung = 1e5\n"}}"#,
        r#"{"arm": {"arm": {"length": 0.2, "radius": 0.01}, "material": {"young": "110 kPa"}, "cable": [{"tension": 0.1}]}}"#,
        r#"{"arm": "silicone", "vary": "cable[0].tension=0:0.5", "max_points": 10, "max_step": 0.4, "branches": false, "format": "csv"}"#,
        r#"{"arm": "silicone", "target": [0.2, "50 mm"], "angle": "10 deg", "station": 0.245, "max_tension": "0.5 N", "tol": 1e-5}"#,
        r#"{"arm": "multi-bending", "format": "svg"}"#,
    ];
    let bodies = bodies.map(|body| body.as_bytes().to_vec()).to_vec();
    let paths = vec!["/api/check", "/api/solve", "/api/solve", "/api/path", "/api/reach", "/api/equilibria"];
    fuzz("api", &(select(paths), mutations_of(bodies)), |(path, body)| {
        let (status, answer) = post(path, &body.0).map_err(|error| format!("no answer: {error}"))?;
        let named =
            || serde_json::from_str::<serde_json::Value>(&answer).is_ok_and(|v| v["error"]["message"].is_string());
        match status {
            200 => Ok(()),
            // Wrong, without an equilibrium, too large, too long, too busy.
            400 | 413 | 422 | 503 | 504 if named() => Ok(()),
            _ => Err(format!("status {status}: {answer}")),
        }
    });
}
