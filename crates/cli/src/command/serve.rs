//! `hydrostat serve`: the viewer.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::path::Path;

use hydrostat_serve::{Given, Options, Server};

use crate::args::ServeArgs;
use crate::output;
use crate::request;
use crate::say;

pub(crate) fn run(args: &ServeArgs) -> anyhow::Result<()> {
    let file = request::arm_file(&args.arm)?;
    // A file that is wrong is better said here than in the page.
    request::arm_anywhere(&file)?;
    let name = Path::new(file.path()).file_name().map_or(args.arm.clone(), |name| name.to_string_lossy().into_owned());
    let given = Some(Given { name, text: file.text().to_owned() });
    let options = Options { address: args.host, port: args.port, names: args.allow_host.clone(), given };
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    runtime.block_on(async {
        let server = Server::bind(options).await?;
        let page = format!("http://{}/", seen_from_here(server.address()));
        output::print(&format!("{page}\n"))?;
        say::line("the viewer runs until Ctrl-C");
        if args.open
            && let Err(error) = open::that_detached(&page)
        {
            say::note(format_args!("no browser could be opened ({error}); open {page} by hand"));
        }
        Ok(server.run().await?)
    })
}

/// An address that a browser on this machine can open.
fn seen_from_here(address: SocketAddr) -> SocketAddr {
    let ip = match address.ip() {
        ip if !ip.is_unspecified() => ip,
        IpAddr::V4(_) => IpAddr::V4(Ipv4Addr::LOCALHOST),
        IpAddr::V6(_) => IpAddr::V6(Ipv6Addr::LOCALHOST),
    };
    SocketAddr::new(ip, address.port())
}
