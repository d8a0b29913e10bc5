//! One viewer's conversation over its WebSocket.
//!
//! The page says which arm under which loads it wants to see, and gets shapes. It may say so faster than shapes are found: of
//! what waits only the newest is answered, so that the picture is never further behind than one solve.

use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::extract::ws::{CloseFrame, Message, WebSocket, close_code};
use hydrostat::{
    Arm, Followed, Follower, NoEquilibrium, Options, ReachError, ReachOptions, SolveError, Solver, Target, Tip,
};
use hydrostat_files::{ArmFile, FailureDocument, Note, SolutionDocument, json};
use serde::{Deserialize, Serialize};
use tokio::time::{sleep, timeout};

use crate::arm_source::{ArmSource, Settings, arm, overridden};
use crate::drawing::{Drawing, Silhouette};
use crate::limits;
use crate::problem::{Details, Problem};
use crate::requests::{read, stations};
use crate::work::{Weight, Work};

/// Stations of an answer where none are asked for.
const STATIONS: usize = 121;

/// Distance to a target over L at which the tip has reached it.
const REACHED: f64 = 1e-6;

/// How far (over L) a target is moved at once: further targets are gone to in parts.
const PART: f64 = 0.05;

/// Most parts.
const PARTS: f64 = 12.0;

/// Tips (over L) further apart than this are different shapes.
const APART: f64 = 1e-4;

/// What the page wants.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct Wish {
    /// Comes back with the answer.
    id: u64,
    /// The arm; left out, that of the wish before.
    arm: Option<ArmSource>,
    #[serde(default)]
    set: Settings,
    stations: Option<serde_json::Number>,
    /// Where the tip is to go, m: then tensions are found, beginning with those of the arm.
    target: Option<[f64; 2]>,
    /// The largest tension (N) of every cable while the tip is pulled; of this and the cable's own the smaller counts.
    max_tension: Option<f64>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Answered<'a> {
    Shape(Box<SolutionDocument<'a>>),
    None(Box<FailureDocument<'a>>),
}

/// Where the tip was pulled to.
#[derive(Debug, Clone, Serialize)]
struct Pulled {
    /// N; these are the tensions of the answer.
    tensions: Vec<f64>,
    reached: bool,
    /// From the target, m.
    distance: f64,
    /// Cables whose tension is at a bound.
    bounds: Vec<BoundOut>,
    /// Whether the arm went to another branch of its equilibria on the way.
    jumped: bool,
    /// Whether a solve from the unloaded arm at these tensions leads to another shape than following did.
    elsewhere: bool,
}

#[derive(Debug, Clone, Serialize)]
struct BoundOut {
    cable: usize,
    kind: &'static str,
}

#[derive(Serialize)]
struct Reply<'a> {
    id: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    answer: Option<Answered<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    drawing: Option<Drawing>,
    /// Only where it is not that of the answer before.
    #[serde(skip_serializing_if = "Option::is_none")]
    ghost: Option<Silhouette>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pulled: Option<Pulled>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Details>,
    /// Wishes that were dropped for newer ones since the answer before.
    dropped: u64,
    /// Time of the work, us.
    microseconds: u128,
}

/// What is kept from wish to wish.
#[derive(Default)]
struct Memory {
    source: Option<(ArmSource, ArmFile)>,
    ghost_of: Option<Arm>,
    following: Option<Following>,
}

/// A tip that is being pulled.
struct Following {
    /// The arm with slack cables, and the bound: what must not change under the follower.
    of: (Arm, Option<f64>),
    follower: Follower,
    at: [f64; 2],
}

/// Answers until the page goes away.
pub(crate) async fn converse(mut socket: WebSocket, work: Arc<Work>) {
    let mut memory = Some(Box::<Memory>::default());
    let mut next: Option<String> = None;
    let mut dropped = 0_u64;
    let (tell, mut told) = tokio::sync::mpsc::channel::<(Box<Memory>, String)>(1);
    loop {
        if memory.is_some()
            && let Some(text) = next.take()
            && let Some(own) = memory.take()
        {
            let (work, tell) = (Arc::clone(&work), tell.clone());
            let lost = std::mem::take(&mut dropped);
            tokio::spawn(async move { tell.send(answer(own, &work, text, lost).await).await });
        }
        tokio::select! {
            received = socket.recv() => match received {
                Some(Ok(Message::Text(text))) => {
                    if next.replace(text.to_string()).is_some() {
                        dropped += 1;
                    }
                }
                Some(Ok(Message::Binary(_))) => return close(socket, close_code::UNSUPPORTED, "expected text").await,
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
            },
            Some((own, text)) = told.recv() => {
                memory = Some(own);
                match timeout(limits::STALLED, socket.send(Message::Text(text.into()))).await {
                    Ok(Ok(())) => {}
                    _ => return,
                }
            }
            () = sleep(limits::SILENCE) => return close(socket, close_code::NORMAL, "nothing was asked for long").await,
        }
    }
}

async fn close(mut socket: WebSocket, code: u16, reason: &'static str) {
    let frame = CloseFrame { code, reason: reason.into() };
    let _ = timeout(Duration::from_secs(1), socket.send(Message::Close(Some(frame)))).await;
}

/// The memory and the reply to one wish.
async fn answer(memory: Box<Memory>, work: &Work, text: String, dropped: u64) -> (Box<Memory>, String) {
    let wish: Wish = match read(text.as_bytes()) {
        Ok(wish) => wish,
        Err(problem) => return (memory, refusal(0, problem, dropped)),
    };
    let id = wish.id;
    let done = work.run(Weight::Light, move |_| {
        let mut memory = memory;
        let text = memory.reply(wish, dropped).unwrap_or_else(|problem| refusal(id, problem, dropped));
        (memory, text)
    });
    // Work that was given up or failed took the memory with it.
    done.await.unwrap_or_else(|problem| (Box::default(), refusal(id, problem, dropped)))
}

fn refusal(id: u64, problem: Problem, dropped: u64) -> String {
    let reply = Reply {
        id,
        answer: None,
        drawing: None,
        ghost: None,
        pulled: None,
        error: Some(problem.body.error),
        dropped,
        microseconds: 0,
    };
    json(&reply)
}

impl Memory {
    fn reply(&mut self, wish: Wish, dropped: u64) -> Result<String, Problem> {
        let start = Instant::now();
        let Wish { id, arm: source, set, stations: asked, target, max_tension } = wish;
        let count = stations(asked)?.unwrap_or(STATIONS);
        let file = self.file(source)?;
        let mut arm = arm(&overridden(file, &set)?)?;
        let mut pulled = None;
        if let Some(target) = target {
            pulled = Some(self.pull(&mut arm, target, max_tension)?);
        } else {
            self.following = None;
        }
        let ghost = self.ghost(&arm, count);
        let mut solver = Solver::new(&arm, Options::default())?;
        let mut reply = Reply { id, answer: None, drawing: None, ghost, pulled, error: None, dropped, microseconds: 0 };
        match solver.solve() {
            Ok(mut shape) => {
                if let (Some(pulled), Some(following)) = (&mut reply.pulled, &self.following) {
                    pulled.elsewhere = apart(following.at, shape.tip(), arm.length);
                }
                let notes = Note::all(&shape, Options::default().tol);
                let margin = shape.fold_margin().value;
                shape.stations = shape.resampled(count);
                reply.drawing = Some(Drawing::new(&shape));
                reply.answer = Some(Answered::Shape(Box::new(SolutionDocument::new(&shape, margin, &notes))));
                reply.microseconds = start.elapsed().as_micros();
                Ok(json(&reply))
            }
            Err(SolveError::NoEquilibrium(failure)) => Ok(without_shape(reply, *failure, count, start)),
            Err(error) => Err(error.into()),
        }
    }

    /// The file of a source, which is read once.
    fn file(&mut self, source: Option<ArmSource>) -> Result<ArmFile, Problem> {
        if let Some(source) = source
            && self.source.as_ref().is_none_or(|(own, _)| *own != source)
        {
            let file = source.file()?;
            self.source = Some((source, file));
        }
        match &self.source {
            Some((_, file)) => Ok(file.clone()),
            None => Err(Problem::missing("arm", "an arm with the first wish")),
        }
    }

    /// The unloaded arm, where it is not the one that the page has.
    fn ghost(&mut self, arm: &Arm, count: usize) -> Option<Silhouette> {
        let bare = arm.unloaded();
        if self.ghost_of.as_ref() == Some(&bare) {
            return None;
        }
        let ghost = Silhouette::unloaded(&bare, count);
        self.ghost_of = Some(bare);
        ghost
    }

    /// Brings the tip of `arm` to the target, or as near as it gets, by its tensions.
    fn pull(&mut self, arm: &mut Arm, target: [f64; 2], most: Option<f64>) -> Result<Pulled, Problem> {
        if !target.iter().all(|v| v.is_finite()) {
            return Err(Problem::field("target", "target: expected two finite numbers, m"));
        }
        let of = (arm.slackened(), most);
        if self.following.as_ref().is_none_or(|own| own.of != of) {
            self.following = Some(begin(arm, of, most)?);
        }
        let Some(following) = &mut self.following else { return Err(Problem::defect()) };
        let length = arm.length;
        let [dx, dy] = [target[0] - following.at[0], target[1] - following.at[1]];
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 1 and PARTS")]
        let parts = (dx.hypot(dy) / (PART * length)).ceil().clamp(1.0, PARTS) as u32;
        let from = following.at;
        let mut jumped = false;
        let mut last: Option<Followed> = None;
        for part in 1..=parts {
            let share = f64::from(part) / f64::from(parts);
            let followed = following.follower.follow(&[Target::tip(from[0] + share * dx, from[1] + share * dy)]);
            match followed {
                Ok(found) => {
                    jumped |= found.jumped;
                    following.at = [found.tip.x, found.tip.y];
                    last = Some(found);
                }
                Err(error) => {
                    self.following = None;
                    return Err(lost(error));
                }
            }
        }
        let Some(found) = last else { return Err(Problem::defect()) };
        for (cable, tension) in arm.cables.iter_mut().zip(&found.tensions) {
            (cable.tension, cable.stroke) = (*tension, None);
        }
        let bound = |(cable, tension): (usize, &f64)| {
            let largest = arm.cables[cable].max_tension.into_iter().chain(most).reduce(f64::min);
            let kind = match largest {
                Some(largest) if *tension >= largest * (1.0 - 1e-9) => "most",
                _ if *tension <= 0.0 => "slack",
                _ => return None,
            };
            Some(BoundOut { cable, kind })
        };
        Ok(Pulled {
            reached: found.reached,
            distance: found.distance * length,
            bounds: found.tensions.iter().enumerate().filter_map(bound).collect(),
            tensions: found.tensions,
            jumped,
            elsewhere: false,
        })
    }
}

/// Takes hold of the tip where it is.
fn begin(arm: &Arm, of: (Arm, Option<f64>), most: Option<f64>) -> Result<Following, Problem> {
    let found = arm.solve()?;
    let tip = found.tip();
    let mut held = of.0.clone();
    // The tensions that commanded strokes have led to are where the pull begins.
    for (cable, state) in held.cables.iter_mut().zip(&found.cables) {
        cable.tension = cable.max_tension.map_or(state.tension, |max| state.tension.min(max));
    }
    let options = ReachOptions { max_tension: most, tol: REACHED, all: false, ..ReachOptions::default() };
    let follower = Follower::new(&held, &[Target::tip(tip.x, tip.y)], &options)?;
    Ok(Following { of, follower, at: [tip.x, tip.y] })
}

fn lost(error: ReachError) -> Problem {
    let mut problem = Problem::from(error);
    problem.body.error.message = format!("the arm cannot follow there: {}", problem.body.error.message);
    problem
}

fn apart(at: [f64; 2], tip: Tip, length: f64) -> bool {
    (at[0] - tip.x).hypot(at[1] - tip.y) > APART * length
}

/// The verdict, with the last good shape to look at.
fn without_shape(mut reply: Reply<'_>, mut failure: NoEquilibrium, count: usize, start: Instant) -> String {
    let notes = failure.last_good.as_ref().map(|c| Note::all(c, f64::INFINITY)).unwrap_or_default();
    let margin = failure.last_good.as_ref().map_or(f64::NAN, |c| c.fold_margin().value);
    if let Some(shape) = &mut failure.last_good {
        shape.stations = shape.resampled(count);
        reply.drawing = Some(Drawing::new(shape));
    }
    let Reply { id, drawing, ghost, pulled, dropped, .. } = reply;
    let reply = Reply {
        id,
        answer: Some(Answered::None(Box::new(FailureDocument::new(&failure, margin, &notes)))),
        drawing,
        ghost,
        pulled,
        error: None,
        dropped,
        microseconds: start.elapsed().as_micros(),
    };
    json(&reply)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    fn wish(text: &str) -> Wish {
        read(text.as_bytes()).unwrap()
    }

    fn reply(memory: &mut Memory, text: &str) -> Value {
        serde_json::from_str(&memory.reply(wish(text), 0).unwrap()).unwrap()
    }

    /// The arm `silicone` at tensions.
    fn silicone(tensions: [f64; 2]) -> Tip {
        let mut arm = ArmSource::Name("silicone".to_owned()).file().unwrap().arm().unwrap();
        for (cable, tension) in arm.cables.iter_mut().zip(tensions) {
            cable.tension = tension;
        }
        arm.solve().unwrap().tip()
    }

    #[test]
    fn a_pulled_tip_is_where_a_solve_at_its_tensions_puts_it() {
        let mut memory = Memory::default();
        let set = r#""set": {"cable[0].tension": 0.4, "cable[1].tension": 0.2}"#;
        reply(&mut memory, &format!(r#"{{"id": 1, "arm": "silicone", {set}}}"#));
        let there = silicone([0.36, 0.23]);
        let pulled = reply(&mut memory, &format!(r#"{{"id": 2, {set}, "target": [{:?}, {:?}]}}"#, there.x, there.y));
        assert_eq!(pulled["pulled"]["reached"], true, "{}", pulled["pulled"]);
        assert_eq!(pulled["pulled"]["elsewhere"], false);
        let tensions = [0, 1].map(|c| pulled["pulled"]["tensions"][c].as_f64().unwrap());
        assert!((tensions[0] - 0.36).abs() < 1e-4 && (tensions[1] - 0.23).abs() < 1e-4, "{tensions:?}");
        let tip = ["x", "y"].map(|k| pulled["answer"]["tip"][k].as_f64().unwrap());
        assert!((tip[0] - there.x).hypot(tip[1] - there.y) < 1e-6);
        let solved = silicone(tensions);
        assert_eq!(tip, [solved.x, solved.y], "the answer is the solve, bit for bit");
    }

    #[test]
    fn where_the_tip_cannot_go_it_says_what_holds_it() {
        let mut memory = Memory::default();
        reply(&mut memory, r#"{"id": 1, "arm": "silicone"}"#);
        let far = reply(&mut memory, r#"{"id": 2, "set": {"cable[0].tension": 0.1}, "target": [0.4, 0]}"#);
        assert_eq!(far["pulled"]["reached"], false);
        assert!(!far["pulled"]["bounds"].as_array().unwrap().is_empty(), "{}", far["pulled"]);
        assert_eq!(far["answer"]["converged"], true);
    }

    #[test]
    fn too_much_tension_is_a_verdict_with_the_last_good_shape() {
        let mut memory = Memory::default();
        let text = r#"{"id": 7, "arm": "silicone", "set": {"cable[0].max_tension": 3, "cable[0].tension": 1.5}}"#;
        let failed = reply(&mut memory, text);
        assert_eq!(failed["answer"]["verdict"]["kind"], "cable_fold");
        assert_eq!(failed["drawing"]["radius"].as_array().unwrap().len(), STATIONS);
        assert_eq!(failed["answer"]["last_good"]["stations"]["s"].as_array().unwrap().len(), STATIONS);
    }

    #[test]
    fn the_ghost_comes_once_and_again_for_another_arm() {
        let mut memory = Memory::default();
        assert!(reply(&mut memory, r#"{"id": 1, "arm": "paper"}"#)["ghost"].is_object());
        assert!(reply(&mut memory, r#"{"id": 2, "set": {"flow.speed": 0.1}}"#)["ghost"].is_null());
        assert!(reply(&mut memory, r#"{"id": 3, "set": {"arm.length": 0.1}}"#)["ghost"].is_object());
    }

    #[test]
    fn the_first_wish_needs_an_arm() {
        let error = Memory::default().reply(wish(r#"{"id": 1}"#), 0).unwrap_err();
        assert_eq!(error.body.error.field.as_deref(), Some("arm"));
    }
}
