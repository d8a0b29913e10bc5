//! The viewer: an arm to pull on, in the browser.
//!
//! [`Server::bind`] opens a port, [`Server::run`] answers on it: the page at `/`, the HTTP interface under `/api/` (described by
//! `/api/openapi.json`, in words by `docs/viewer.md`) and the page's WebSocket at `/api/session`. Everything that is served is inside the
//! program, and no request reaches the file system.
//!
//! What an answer says is what the program says: solves start from the unloaded arm, and documents are those of `hydrostat-files`.
//!
//! ```no_run
//! use hydrostat_serve::{Options, Server};
//!
//! # async fn example() -> Result<(), hydrostat_serve::ServeError> {
//! let server = Server::bind(Options::default()).await?; // 127.0.0.1, port 8080
//! println!("http://{}/", server.address());
//! server.run().await
//! # }
//! ```

mod answers;
mod arm_source;
mod assets;
mod drawing;
mod guard;
mod hand;
mod limits;
mod motion;
mod moving;
mod openapi;
mod options;
mod problem;
mod pull;
mod requests;
mod routes;
mod server;
mod session;
mod shape;
mod work;

pub use arm_source::Given;
pub use server::{Options, ServeError, Server};
