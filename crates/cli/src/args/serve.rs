//! Arguments of `hydrostat serve`.

use std::net::{IpAddr, Ipv4Addr};

use clap::Args as ClapArgs;

const EXIT: &str = "\
Exit status:
  0  interrupted (Ctrl-C)
  2  wrong request: arguments, arm file, or a port that is not available
  1  any other error";

/// Shows an arm in the browser: drag its tip, change its loads, and see the shape, the forces and the verdict.
///
/// The viewer is part of the program and needs no network. Only this machine can open it, unless --host says otherwise.
#[derive(Debug, ClapArgs)]
#[command(after_help = format!("\
Examples:
  hydrostat serve --open
  hydrostat serve my.toml --port 9000
  hydrostat serve silicone --host 0.0.0.0 --allow-host arm.lab.example

{EXIT}"))]
pub(crate) struct ServeArgs {
    /// Arm file, or name of a shipped arm, to start with
    #[arg(value_name = "ARM", default_value = "silicone")]
    pub(crate) arm: String,
    /// Port; 0 takes any free one
    #[arg(long, value_name = "PORT", default_value = "8080")]
    pub(crate) port: u16,
    /// Open the page in the browser
    #[arg(long)]
    pub(crate) open: bool,
    /// Address to listen on; with 0.0.0.0 other machines can connect
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::LOCALHOST))]
    pub(crate) host: IpAddr,
    /// Host name, besides localhost, under which browsers may address the server. Repeatable
    #[arg(long, value_name = "NAME")]
    pub(crate) allow_host: Vec<String>,
}
