//! One viewer's conversation over its WebSocket.
//!
//! The page says which arm under which loads it wants to see, and gets shapes. It may say so faster than shapes are found: of
//! what waits only the newest is answered, so that the picture is never further behind than one solve.

use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::extract::ws::{CloseFrame, Message, WebSocket, close_code};
use hydrostat::{Arm, Configuration, Options, SpatialConfiguration};
use hydrostat_files::{ArmFile, json};
use serde::{Deserialize, Serialize};
use tokio::time::{sleep, timeout};

use crate::answers::with_slips;
use crate::arm_source::{ArmSource, Settings, arm, overridden};
use crate::drawing::{Drawing, Silhouette};
use crate::limits;
use crate::motion::{MotionOut, MotionWish, Run, no_run};
use crate::problem::{Details, Problem};
use crate::pull::{Pull, Pulled};
use crate::requests::{read, stations};
use crate::shape::{Answered, Shape, Unsolved};
use crate::work::{Weight, Work};

/// Stations of an answer where none are asked for.
const STATIONS: usize = 121;

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
    /// Where the tip is to go, two numbers in the plane and three in space, m: then tensions are found, beginning with
    /// those of the arm.
    target: Option<Vec<f64>>,
    /// The largest tension (N) of every cable while the tip is pulled; of this and the cable's own the smaller counts.
    max_tension: Option<f64>,
    /// The arm in motion in place of its equilibrium.
    motion: Option<MotionWish>,
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
    motion: Option<MotionOut>,
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
    pull: Option<Pull>,
    /// The arm in motion, until something else is wished.
    run: Option<Run>,
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
    json(&Reply { error: Some(problem.body.error), ..Reply::to(id, dropped) })
}

impl Reply<'_> {
    /// One that says nothing yet.
    fn to(id: u64, dropped: u64) -> Self {
        Self {
            id,
            answer: None,
            drawing: None,
            ghost: None,
            pulled: None,
            motion: None,
            error: None,
            dropped,
            microseconds: 0,
        }
    }
}

impl Memory {
    fn reply(&mut self, wish: Wish, dropped: u64) -> Result<String, Problem> {
        let start = Instant::now();
        let Wish { id, arm: source, set, stations: asked, target, max_tension, motion } = wish;
        let count = stations(asked)?.unwrap_or(STATIONS);
        if let Some(motion) = motion {
            let reply = self.moved(Reply::to(id, dropped), source, &set, count, &motion)?;
            return Ok(json(&Reply { microseconds: start.elapsed().as_micros(), ..reply }));
        }
        self.run = None;
        let file = self.file(source)?;
        let mut arm = arm(&overridden(file, &set)?)?;
        let mut pulled = None;
        if let Some(target) = target {
            pulled = Some(self.pull(&mut arm, &target, max_tension)?);
        } else {
            self.pull = None;
        }
        let ghost = self.ghost(&arm, count);
        let reply = Reply { ghost, pulled, ..Reply::to(id, dropped) };
        if arm.space.is_some() {
            self.shown::<SpatialConfiguration>(reply, &arm, count, start)
        } else {
            self.shown::<Configuration>(reply, &arm, count, start)
        }
    }

    /// The reply with the arm in motion.
    fn moved<'a>(
        &mut self,
        mut reply: Reply<'a>,
        source: Option<ArmSource>,
        set: &Settings,
        count: usize,
        wish: &MotionWish,
    ) -> Result<Reply<'a>, Problem> {
        self.pull = None;
        if wish.start {
            self.run = None;
            let file = overridden(self.file(source)?, set)?;
            let arm = arm(&file)?;
            reply.ghost = self.ghost(&arm, count);
            let run = Run::begin(file, arm, count)?;
            reply.drawing = Some(Drawing::at(run.arm(), &run.places));
            self.run = Some(run);
        }
        let run = self.run.as_mut().ok_or_else(no_run)?;
        reply.motion = Some(run.answer(wish)?);
        Ok(reply)
    }

    /// The reply with the shape of `arm`, or with the verdict and the last good shape to look at.
    fn shown<C: Shape>(&self, mut reply: Reply<'_>, arm: &Arm, count: usize, start: Instant) -> Result<String, Problem>
    where
        Problem: From<Box<C::Failure>>,
    {
        let tol = Options::default().tol;
        let done = |reply: Reply<'_>, answer| {
            let microseconds = start.elapsed().as_micros();
            json(&Reply { answer: Some(answer), microseconds, ..reply })
        };
        match C::solve(arm, tol) {
            Ok(mut shape) => {
                if let (Some(pulled), Some(pull)) = (&mut reply.pulled, &self.pull) {
                    pulled.elsewhere = apart(pull.at, shape.tip(), arm.length);
                }
                let notes = with_slips(arm, shape.notes(tol));
                shape.resample(count);
                reply.drawing = Some(shape.drawing());
                Ok(done(reply, shape.document(&notes)))
            }
            Err(Unsolved::Verdict(mut failure)) => {
                let mut notes = Vec::new();
                if let Some(shape) = C::last_good(&mut failure) {
                    notes = shape.notes(f64::INFINITY);
                    shape.resample(count);
                    reply.drawing = Some(shape.drawing());
                }
                Ok(done(reply, C::failure(&failure, &with_slips(arm, notes), None)))
            }
            Err(Unsolved::Refused(problem)) => Err(problem),
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
    fn pull(&mut self, arm: &mut Arm, target: &[f64], most: Option<f64>) -> Result<Pulled, Problem> {
        let place = match (target, arm.space.is_some()) {
            ([x, y], false) => [*x, *y, 0.0],
            ([x, y, z], true) => [*x, *y, *z],
            (_, in_space) => return Err(Problem::target(if in_space { 3 } else { 2 })),
        };
        if !place.iter().all(|v| v.is_finite()) {
            return Err(Problem::target(target.len()));
        }
        let mut pull = match self.pull.take() {
            Some(pull) if pull.is_of(arm, most) => pull,
            _ => Pull::begin(arm, most)?,
        };
        let pulled = pull.to(place, arm)?;
        self.pull = Some(pull);
        Ok(pulled)
    }
}

fn apart(a: [f64; 3], b: [f64; 3], length: f64) -> bool {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt() > APART * length
}

#[cfg(test)]
mod tests {
    use super::*;
    use hydrostat::Tip;
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
    fn a_tip_pulled_in_space_is_where_a_solve_at_its_tensions_puts_it() {
        let mut memory = Memory::default();
        let first = reply(&mut memory, r#"{"id": 1, "arm": "silicone-spatial", "stations": 11}"#);
        let tip = ["x", "y", "z"].map(|key| first["answer"]["tip"][key].as_f64().unwrap());
        assert_eq!(first["ghost"]["a"].as_array().unwrap().len(), 11);
        assert_eq!(first["drawing"]["offsets_c"].as_array().unwrap().len(), 3);
        let target = [tip[0] - 0.002, tip[1] + 0.01, tip[2] - 0.004];
        let pulled = reply(&mut memory, &format!(r#"{{"id": 2, "target": {target:?}}}"#));
        assert_eq!(pulled["pulled"]["elsewhere"], false, "{}", pulled["pulled"]);
        let off: f64 = ["x", "y", "z"]
            .iter()
            .zip(target)
            .map(|(key, to)| (pulled["answer"]["tip"][key].as_f64().unwrap() - to).powi(2))
            .sum();
        let distance = pulled["pulled"]["distance"].as_f64().unwrap();
        assert!((off.sqrt() - distance).abs() < 1e-6, "{} against {distance}", off.sqrt());
        // The place is out of reach of cables that cannot push: the nearest is what `reach` finds.
        assert!((distance - 0.003_842).abs() < 1e-6, "{distance}");
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
