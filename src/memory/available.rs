//! How much memory there is: the least of what the machine, the control groups of the process and its own limits leave.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// Bytes that can be had without swapping and without meeting a limit; `None` where the system does not say.
pub(crate) fn available_bytes() -> Option<u64> {
    available_bytes_below(Path::new("/"))
}

/// The same as the files of a system whose root is `root` tell it.
#[doc(hidden)]
pub fn available_bytes_below(root: &Path) -> Option<u64> {
    let limits = [of_machine(root), of_groups(root), of_process(root)];
    limits.into_iter().flatten().min()
}

/// What the machine has.
fn of_machine(root: &Path) -> Option<u64> {
    kilobytes(&read(root, "proc/meminfo")?, "MemAvailable:")
}

/// What the limits of the process itself leave: its addresses, and its data.
fn of_process(root: &Path) -> Option<u64> {
    let (limits, status) = (read(root, "proc/self/limits")?, read(root, "proc/self/status")?);
    let left = |limit: &str, used: &str| {
        let soft = limits.lines().find_map(|line| line.strip_prefix(limit))?.split_whitespace().next()?;
        // `unlimited` is no number.
        Some(soft.parse::<u64>().ok()?.saturating_sub(kilobytes(&status, used)?))
    };
    let lefts = [left("Max address space", "VmSize:"), left("Max data size", "VmData:")];
    lefts.into_iter().flatten().min()
}

/// The files of one version of control groups.
struct Version {
    /// Where its groups are, below the root.
    mount: &'static str,
    /// What a group may use: bytes, or a word that is no number. The second one is where it is slowed down.
    limits: &'static [&'static str],
    /// What it uses.
    usage: &'static str,
    /// In `memory.stat`: what of that is only kept in case that it is read from the disk again.
    reclaimable: &'static str,
}

const FIRST: Version = Version {
    mount: "sys/fs/cgroup/memory",
    limits: &["memory.limit_in_bytes"],
    usage: "memory.usage_in_bytes",
    reclaimable: "total_inactive_file ",
};

const SECOND: Version = Version {
    mount: "sys/fs/cgroup",
    limits: &["memory.max", "memory.high"],
    usage: "memory.current",
    reclaimable: "inactive_file ",
};

/// What the control groups that the process is in leave. Each limits all that are below it.
fn of_groups(root: &Path) -> Option<u64> {
    let text = read(root, "proc/self/cgroup")?;
    let groups = text.lines().filter_map(|line| {
        // Such as `4:cpu,memory:/user` of the first version, `0::/user` of the second.
        let mut fields = line.splitn(3, ':').skip(1);
        let (controllers, path) = (fields.next()?, fields.next()?);
        match controllers {
            "" => Some((SECOND, path)),
            _ if controllers.split(',').any(|name| name == "memory") => Some((FIRST, path)),
            _ => None,
        }
    });
    groups.filter_map(|(version, path)| version.left(root, path)).min()
}

impl Version {
    /// What the group at `path` and all above it leave. A container may see its own group as the top one, but be told its path
    /// from outside: folders that are not there are passed over.
    fn left(&self, root: &Path, path: &str) -> Option<u64> {
        let mount = root.join(self.mount);
        let names = Path::new(path).components().filter(|part| matches!(part, Component::Normal(_)));
        let group: PathBuf = names.collect();
        group.ancestors().filter_map(|group| self.left_in(&mount.join(group))).min()
    }

    fn left_in(&self, folder: &Path) -> Option<u64> {
        let number = |name: &str| read(folder, name)?.trim().parse::<u64>().ok();
        let limit = self.limits.iter().filter_map(|name| number(name)).min()?;
        let statistics = read(folder, "memory.stat").unwrap_or_default();
        let reclaimable = statistics.lines().find_map(|line| line.strip_prefix(self.reclaimable));
        let reclaimable = reclaimable.and_then(|bytes| bytes.trim().parse().ok()).unwrap_or(0);
        let used = number(self.usage).unwrap_or(0).saturating_sub(reclaimable);
        Some(limit.saturating_sub(used))
    }
}

/// The bytes that a line like `MemAvailable:  1234 kB` tells.
fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

fn read(folder: &Path, name: &str) -> Option<String> {
    fs::read_to_string(folder.join(name)).ok()
}
