//! Who works when: threads that solve, in the order in which requests came, and for a bounded time.
//!
//! Solves take milliseconds and paths seconds. Each kind has its own places, so that paths of one viewer do not keep the
//! arms of others from moving. A place is given back when the work is done, not when whoever asked for it has gone.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::available_parallelism;
use std::time::{Duration, Instant};

use tokio::sync::{OwnedSemaphorePermit, Semaphore};
use tokio::task::spawn_blocking;
use tokio::time::timeout;

use crate::limits;
use crate::problem::Problem;

/// How much work a request is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weight {
    /// One solve.
    Light,
    /// A path, a search.
    Heavy,
}

/// The places at which work is done.
#[derive(Debug)]
pub(crate) struct Work {
    light: Arc<Semaphore>,
    heavy: Arc<Semaphore>,
    waiting: AtomicUsize,
    time: Duration,
}

/// When a request has to have its answer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Deadline(Instant);

impl Deadline {
    pub(crate) fn is_ahead(self) -> bool {
        Instant::now() < self.0
    }
}

/// One of those who wait; counted while it lives.
struct Waiting<'a>(&'a AtomicUsize);

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Work {
    pub(crate) fn new(time: Duration) -> Self {
        let cores = available_parallelism().map_or(2, std::num::NonZero::get);
        Self {
            light: Arc::new(Semaphore::new(cores)),
            heavy: Arc::new(Semaphore::new((cores / 2).max(1))),
            waiting: AtomicUsize::new(0),
            time,
        }
    }

    /// Does `job` on a thread of its own when its turn comes.
    pub(crate) async fn run<T, F>(&self, weight: Weight, job: F) -> Result<T, Problem>
    where
        T: Send + 'static,
        F: FnOnce(Deadline) -> T + Send + 'static,
    {
        let place = self.place(weight).await?;
        let deadline = Deadline(Instant::now() + self.time);
        let work = spawn_blocking(move || {
            let done = job(deadline);
            drop(place);
            done
        });
        // Paths and searches look at the deadline; they get a little longer to write down what they have.
        match timeout(self.time + Duration::from_secs(1), work).await {
            Ok(Ok(done)) => Ok(done),
            Ok(Err(_)) => Err(Problem::defect()),
            Err(_) => Err(Problem::too_long()),
        }
    }

    async fn place(&self, weight: Weight) -> Result<OwnedSemaphorePermit, Problem> {
        let places = match weight {
            Weight::Light => &self.light,
            Weight::Heavy => &self.heavy,
        };
        if self.waiting.fetch_add(1, Ordering::Relaxed) >= limits::WAITING {
            self.waiting.fetch_sub(1, Ordering::Relaxed);
            return Err(Problem::busy("too many requests are waiting; try again in a second"));
        }
        let _waiting = Waiting(&self.waiting);
        match timeout(limits::PATIENCE, Arc::clone(places).acquire_owned()).await {
            Ok(Ok(place)) => Ok(place),
            _ => Err(Problem::busy("the server is busy; try again in a second")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn work_past_its_time_is_given_up_and_keeps_its_place_until_it_ends() {
        let work = Work::new(Duration::from_millis(1));
        let before = work.heavy.available_permits();
        let (tell, told) = std::sync::mpsc::channel::<()>();
        let late = work.run(Weight::Heavy, move |deadline| {
            while deadline.is_ahead() {}
            let _ = told.recv();
        });
        assert_eq!(late.await.unwrap_err().body.error.kind, "time_limit");
        assert_eq!(work.heavy.available_permits(), before - 1);
        tell.send(()).unwrap();
        while work.heavy.available_permits() < before {
            tokio::task::yield_now().await;
        }
    }

    #[tokio::test]
    async fn a_defect_of_the_work_is_said_and_gives_its_place_back() {
        let work = Work::new(Duration::from_secs(5));
        let before = work.light.available_permits();
        let broken = work.run(Weight::Light, |_| -> () { panic!("on purpose") }).await;
        assert_eq!(broken.unwrap_err().body.error.kind, "defect");
        assert_eq!(work.light.available_permits(), before);
        assert_eq!(work.run(Weight::Light, |_| 7).await.unwrap(), 7);
        assert_eq!(work.waiting.load(Ordering::Relaxed), 0);
    }
}
