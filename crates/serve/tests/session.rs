//! The WebSocket from outside: what is dropped, what is refused, who has to wait for whom, and that all messages are as described.

use std::net::SocketAddr;
use std::time::Duration;

use futures_util::{SinkExt, StreamExt};
use hydrostat_serve::{Options, Server};
use jsonschema::Validator;
use serde_json::{Value, json};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::{Error, Message};
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream, connect_async};

type Socket = WebSocketStream<MaybeTlsStream<TcpStream>>;

async fn server() -> SocketAddr {
    let server = Server::bind(Options { port: 0, ..Options::default() }).await.unwrap();
    let address = server.address();
    tokio::spawn(server.run());
    address
}

async fn session(address: SocketAddr) -> Socket {
    connect_async(format!("ws://{address}/api/session")).await.unwrap().0
}

async fn ask(socket: &mut Socket, message: &Value) {
    socket.send(Message::text(message.to_string())).await.unwrap();
}

async fn reply(socket: &mut Socket) -> Value {
    loop {
        let message = tokio::time::timeout(Duration::from_mins(1), socket.next()).await.unwrap().unwrap().unwrap();
        if let Message::Text(text) = message {
            return serde_json::from_str(&text).unwrap();
        }
    }
}

/// What is wrong with a message as the server describes wishes and replies.
struct Described {
    wish: Validator,
    reply: Validator,
}

impl Described {
    async fn by(address: SocketAddr) -> Self {
        let mut stream = TcpStream::connect(address).await.unwrap();
        let request = format!("GET /api/session.schema.json HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n");
        stream.write_all(request.as_bytes()).await.unwrap();
        let mut text = String::new();
        stream.read_to_string(&mut text).await.unwrap();
        let schema: Value = serde_json::from_str(text.split_once("\r\n\r\n").unwrap().1).unwrap();
        let of = |kind: &str| {
            let mut schema = schema.clone();
            schema["oneOf"] = json!([{ "$ref": format!("#/$defs/{kind}") }]);
            jsonschema::validator_for(&schema).unwrap()
        };
        Self { wish: of("Wish"), reply: of("Reply") }
    }

    fn check(validator: &Validator, message: &Value) {
        let errors: Vec<String> = validator.iter_errors(message).map(|error| error.to_string()).collect();
        assert!(errors.is_empty(), "{errors:?}: {message}");
    }
}

fn pulled(id: u64) -> Value {
    json!({ "id": id, "arm": "silicone", "set": { "cable[0].tension": 0.001 * f64::from(u32::try_from(id).unwrap()) } })
}

#[tokio::test(flavor = "multi_thread")]
async fn of_wishes_that_wait_the_newest_is_answered() {
    let mut socket = session(server().await).await;
    for id in 1..=300 {
        socket.feed(Message::text(pulled(id).to_string())).await.unwrap();
    }
    socket.flush().await.unwrap();
    let (mut last, mut answered, mut dropped) = (0, 0, 0);
    while last < 300 {
        let reply = reply(&mut socket).await;
        let id = reply["id"].as_u64().unwrap();
        assert!(id > last, "answers are in order");
        assert_eq!(reply["answer"]["converged"], true);
        let tension = reply["answer"]["cables"][0]["tension"].as_f64().unwrap();
        assert!((tension - 0.001 * id as f64).abs() < 1e-12, "an answer is that of its own wish");
        (last, answered) = (id, answered + 1);
        dropped += reply["dropped"].as_u64().unwrap();
    }
    assert_eq!(answered + dropped, 300, "{answered} answered, {dropped} dropped");
    assert!(dropped > 0);
}

#[tokio::test(flavor = "multi_thread")]
async fn what_is_no_wish_is_refused_and_the_session_goes_on() {
    let mut socket = session(server().await).await;
    for (wrong, field) in [
        (json!({ "id": 1 }), "arm"),
        (json!({ "id": 1, "arm": "nobody" }), "arm"),
        (json!({ "id": 1, "arm": "paper", "stations": 100_000 }), "stations"),
        (json!({ "id": 1, "arm": "paper", "set": { "flow.speed": -1 } }), "set"),
        (json!({ "id": 1, "arm": "paper", "target": [0.1] }), "target"),
        (json!({ "id": 1, "arm": "silicone-spatial", "target": [0.1, 0.1] }), "target"),
        (
            json!({ "id": 1, "arm": { "toml": "[arm]\nlength = 0.1\nradius = 0.01\n[material]\nyoung = 1e5" }, "target": [0.1, 0] }),
            "arm",
        ),
        (json!({ "id": 1, "arm": "silicone", "motion": { "by": 0.1 } }), "motion"),
        (json!({ "id": 1, "arm": "silicone", "motion": { "start": true, "by": 1 } }), "motion.by"),
        (json!({ "id": 1, "arm": "silicone", "motion": { "start": true } }), "motion"),
        (json!("what"), "body"),
    ] {
        ask(&mut socket, &wrong).await;
        let reply = reply(&mut socket).await;
        assert!(reply["answer"].is_null());
        let found = reply["error"]["field"].as_str().unwrap();
        assert!(found.starts_with(field), "{wrong}: {reply}");
    }
    ask(&mut socket, &pulled(2)).await;
    assert_eq!(reply(&mut socket).await["answer"]["converged"], true);
}

#[tokio::test(flavor = "multi_thread")]
async fn messages_are_as_their_schema_says() {
    let address = server().await;
    let described = Described::by(address).await;
    let mut socket = session(address).await;
    let stream = json!({ "flow.speed": 0.2, "flow.direction": 90, "cable[0].tension": 0.3 });
    for (wish, holds) in [
        (json!({ "id": 1, "arm": "silicone", "set": stream, "stations": 21 }), &["answer", "drawing", "ghost"][..]),
        (
            json!({ "id": 2, "set": { "cable[0].tension": 0.2 }, "target": [0.2, 0.05], "max_tension": 0.6 }),
            &["pulled"],
        ),
        (
            json!({ "id": 3, "arm": "silicone", "set": { "cable[0].max_tension": 3, "cable[0].tension": 1.5 } }),
            &["answer"],
        ),
        (json!({ "id": 4, "arm": "nobody" }), &["error"]),
        (json!({ "id": 5, "arm": "silicone", "set": { "flow.speed": "a lot" } }), &["error"]),
        (json!({ "id": 6, "arm": "silicone-spatial", "set": stream, "stations": 21 }), &["answer", "drawing", "ghost"]),
        (
            json!({ "id": 7, "set": { "cable[0].tension": 0.1 }, "target": [0.22, 0.08, 0.02], "max_tension": 0.6 }),
            &["pulled"],
        ),
        (
            json!({ "id": 8, "arm": "silicone-spatial", "set": { "cable[0].max_tension": 3, "cable[0].tension": 2.5 } }),
            &["answer"],
        ),
    ] {
        if wish["arm"] != "nobody" {
            Described::check(&described.wish, &wish);
        }
        ask(&mut socket, &wish).await;
        let reply = reply(&mut socket).await;
        Described::check(&described.reply, &reply);
        assert!(holds.iter().all(|key| reply[key].is_object()), "{reply}");
    }
    for (wish, holds) in [
        (
            json!({ "id": 9, "arm": "silicone", "set": stream, "stations": 21, "motion": { "start": true, "by": 0.01 } }),
            &["motion", "drawing", "ghost"][..],
        ),
        (json!({ "id": 10, "motion": { "by": 0.02, "hold": [0.2, 0.1] } }), &["motion"]),
        (
            json!({ "id": 11, "motion": { "by": 0.02, "loads": { "cable[0].tension": "100 mN" }, "within": 0.1 } }),
            &["motion"],
        ),
        (json!({ "id": 12, "motion": { "by": 0.02, "loads": { "cable[0].tension": 0 } } }), &["motion"]),
        (json!({ "id": 13, "motion": { "by": 0.02, "loads": { "arm.length": 1 } } }), &["error"]),
        (
            json!({ "id": 14, "arm": "silicone-spatial", "stations": 21, "motion": { "start": true, "by": 0.01 } }),
            &["motion", "drawing", "ghost"],
        ),
        (json!({ "id": 15, "motion": { "by": 0.01, "hold": [0.2, 0.1, 0.05] } }), &["motion"]),
        (json!({ "id": 16, "arm": "silicone" }), &["answer"]),
        (json!({ "id": 17, "motion": { "by": 0.01 } }), &["error"]),
    ] {
        Described::check(&described.wish, &wish);
        ask(&mut socket, &wish).await;
        let reply = reply(&mut socket).await;
        Described::check(&described.reply, &reply);
        assert!(holds.iter().all(|key| reply[key].is_object()), "{reply}");
    }
    for wrong in [json!({ "id": -1 }), json!({ "arm": "paper" }), json!({ "id": 1, "more": 1 }), json!([])] {
        assert!(!described.wish.is_valid(&wrong), "{wrong}");
        ask(&mut socket, &wrong).await;
        let refusal = reply(&mut socket).await;
        Described::check(&described.reply, &refusal);
        assert!(refusal["error"].is_object(), "{refusal}");
    }
    for wrong in [
        json!({ "id": 1, "dropped": 0, "microseconds": 0 }),
        json!({ "id": 1, "error": {}, "dropped": 0, "microseconds": 0 }),
    ] {
        assert!(!described.reply.is_valid(&wrong), "{wrong}");
    }
}

/// However much is asked for, a message works for a bounded time and says how far it came.
#[tokio::test(flavor = "multi_thread")]
async fn a_message_moves_an_arm_for_a_bounded_time() {
    let mut socket = session(server().await).await;
    let start = json!({ "id": 1, "arm": "octopus-spatial", "stations": 11, "motion": { "start": true, "by": 0 } });
    ask(&mut socket, &start).await;
    assert_eq!(reply(&mut socket).await["motion"]["shape"]["time"], 0.0);
    let mut time = 0.0;
    for id in 2..12 {
        let hold = [0.1, 0.05 * f64::from(id % 3), 0.05];
        ask(&mut socket, &json!({ "id": id, "motion": { "by": 0.25, "hold": hold } })).await;
        let reply = reply(&mut socket).await;
        let now = reply["motion"]["shape"]["time"].as_f64().unwrap_or_else(|| panic!("{reply}"));
        assert!(now > time && now <= time + 0.25 + 1e-9, "{time} {now}");
        time = now;
        assert!(reply["microseconds"].as_u64().unwrap() < 5_000_000, "{}", reply["microseconds"]);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn foreign_pages_get_no_session() {
    let address = server().await;
    let mut request = format!("ws://{address}/api/session").into_client_request().unwrap();
    request.headers_mut().insert("Origin", "http://elsewhere.example".parse().unwrap());
    match connect_async(request).await {
        Err(Error::Http(response)) => assert_eq!(response.status(), 403),
        other => panic!("expected a refusal, found {other:?}"),
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn thirty_viewers_are_served_in_turn() {
    const VIEWERS: u64 = 30;
    const WISHES: u64 = 8;
    let address = server().await;
    let viewers: Vec<_> = (0..VIEWERS)
        .map(|viewer| {
            tokio::spawn(async move {
                let mut socket = session(address).await;
                for wish in 1..=WISHES {
                    ask(&mut socket, &pulled(wish * VIEWERS + viewer)).await;
                    let reply = reply(&mut socket).await;
                    assert_eq!(reply["id"], wish * VIEWERS + viewer);
                    assert!(reply["answer"].is_object(), "{reply}");
                }
                viewer
            })
        })
        .collect();
    for viewer in viewers {
        viewer.await.unwrap();
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn there_are_seats_for_so_many_and_they_are_given_back() {
    let address = server().await;
    let mut seated = Vec::new();
    let refused = loop {
        match connect_async(format!("ws://{address}/api/session")).await {
            Ok((socket, _)) => seated.push(socket),
            Err(Error::Http(response)) => break response.status(),
            Err(other) => panic!("{other}"),
        }
    };
    assert_eq!((refused.as_u16(), seated.len()), (503, 64));
    seated.clear();
    for _ in 0..100 {
        if connect_async(format!("ws://{address}/api/session")).await.is_ok() {
            return;
        }
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    panic!("seats are not given back");
}

/// The bound that a pull is asked to keep may be below the cable's own.
#[tokio::test(flavor = "multi_thread")]
async fn a_cable_at_a_bound_below_its_own_was_not_named() {
    let mut socket = session(server().await).await;
    let wish = json!({
        "id": 1, "arm": "silicone", "set": { "cable[0].max_tension": 1.5 }, "target": [0.05, 0.2], "max_tension": 0.2,
    });
    ask(&mut socket, &wish).await;
    let reply = reply(&mut socket).await;
    let pulled = &reply["pulled"];
    assert_eq!(pulled["reached"], false, "{reply}");
    assert!((pulled["tensions"][0].as_f64().unwrap() - 0.2).abs() < 1e-9, "{pulled}");
    let bounds = pulled["bounds"].as_array().unwrap();
    assert!(bounds.contains(&json!({ "cable": 0, "kind": "most" })), "{pulled}");
}
