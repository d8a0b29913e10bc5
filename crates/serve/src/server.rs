//! The port and what answers on it.

use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;

use axum::Router;
use tokio::net::TcpListener;

use crate::arm_source::Given;
use crate::limits;
use crate::routes::{Shared, router};
use crate::work::Work;

/// How a server is set up.
#[derive(Debug, Clone)]
pub struct Options {
    /// The address to listen on; loopback is seen from this machine alone.
    pub address: IpAddr,
    /// The port; 0 is any that is free.
    pub port: u16,
    /// Names, beside `localhost`, that requests may address the server by.
    pub names: Vec<String>,
    /// The arm that the page starts with, if not the first of the shipped ones.
    pub given: Option<Given>,
}

impl Default for Options {
    fn default() -> Self {
        Self { address: IpAddr::V4(Ipv4Addr::LOCALHOST), port: 8080, names: Vec::new(), given: None }
    }
}

/// Why there is no server.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The port cannot be had.
    #[error("{address}: cannot be listened on: {source}")]
    Bind {
        /// The address with its port.
        address: SocketAddr,
        /// Why.
        source: io::Error,
    },
    /// Connections cannot be taken any more.
    #[error("the server ended: {0}")]
    Run(#[from] io::Error),
}

/// A port with the viewer behind it.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    router: Router,
}

impl Server {
    /// Takes the port. From then on connections wait for [`Server::run`].
    ///
    /// # Errors
    /// [`ServeError::Bind`].
    pub async fn bind(options: Options) -> Result<Self, ServeError> {
        let asked = SocketAddr::new(options.address, options.port);
        let refuse = |source| ServeError::Bind { address: asked, source };
        let listener = TcpListener::bind(asked).await.map_err(refuse)?;
        let address = listener.local_addr().map_err(refuse)?;
        let shared = Shared {
            given: options.given.map(Arc::new),
            work: Arc::new(Work::new(limits::TIME)),
            sessions: Arc::new(AtomicUsize::new(0)),
        };
        Ok(Self { listener, address, router: router(shared, options.names.into()) })
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Answers until the process is interrupted (Ctrl-C).
    ///
    /// # Errors
    /// [`ServeError::Run`].
    pub async fn run(self) -> Result<(), ServeError> {
        tokio::select! {
            ended = async { axum::serve(self.listener, self.router).await } => Ok(ended?),
            // Viewers keep their connections open for as long as they look: nothing is waited for.
            interrupted = tokio::signal::ctrl_c() => Ok(interrupted?),
        }
    }
}
