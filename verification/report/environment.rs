//! What a run was made with.

use std::fs;
use std::process::Command;
use std::thread::available_parallelism;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::Serialize;

/// Machine, compiler and state of the sources; "unknown" where the system does not tell.
#[derive(Clone, Debug, Serialize)]
pub struct Environment {
    pub version: &'static str,
    /// Hash of the last commit, and whether there are changes beyond it.
    pub commit: String,
    pub compiler: String,
    pub processor: String,
    pub system: String,
    pub cores: usize,
    /// Seconds since 1970-01-01, UTC.
    pub time: u64,
}

impl Environment {
    /// Asks the system.
    pub fn find() -> Self {
        let unknown = || "unknown".to_string();
        let changed = command("git", &["status", "--porcelain"]).is_some_and(|text| !text.is_empty());
        let commit = command("git", &["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(unknown);
        let processor = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            line.split_once(':').map(|(_, name)| name.trim().to_string())
        });
        Self {
            version: env!("CARGO_PKG_VERSION"),
            commit: if changed { commit + " and changes" } else { commit },
            compiler: command("rustc", &["--version"]).unwrap_or_else(unknown),
            processor: processor.unwrap_or_else(unknown),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            cores: available_parallelism().map_or(1, usize::from),
            time: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
        }
    }
}

/// The first line that a program prints in the repository.
fn command(program: &str, arguments: &[&str]) -> Option<String> {
    let output =
        Command::new(program).args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.lines().next().unwrap_or_default().to_string())
}
