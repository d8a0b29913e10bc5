//! Arguments of `hydrostat serve`.

use std::net::{IpAddr, Ipv4Addr};

use clap::Args as ClapArgs;

const EXIT: &str = "\
Exit status:
  0  interrupted (Ctrl-C)
  2  the request is wrong: arguments, arm file, a port that cannot be had
  1  anything else";

/// Shows an arm in the browser: drag its tip, move its loads, and see the shape, what it carries and what the solver says of it.
///
/// Everything is inside the program and no network is needed. Only this machine sees the viewer, unless --host says otherwise.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat serve --open
  hydrostat serve my.toml --port 9000
  hydrostat serve silicone --host 0.0.0.0 --allow-host arm.lab.example

{EXIT}"))]
pub(crate) struct ServeArgs {
    /// An arm file, or the name of a shipped arm, to start with
    #[arg(value_name = "ARM", default_value = "paper")]
    pub(crate) arm: String,
    /// The port; 0 takes any that is free
    #[arg(long, value_name = "PORT", default_value = "8080")]
    pub(crate) port: u16,
    /// Open the page in the browser
    #[arg(long)]
    pub(crate) open: bool,
    /// The address to listen on; 0.0.0.0 is seen from other machines
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    pub(crate) host: IpAddr,
    /// A name, beside localhost, by which browsers may address the server
    #[arg(long, value_name = "NAME")]
    pub(crate) allow_host: Vec<String>,
}
