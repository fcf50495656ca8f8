//! What one build cost this process: processor time of all threads, wall clock, and memory above what was held.
//!
//! *Idea.* The kernel keeps the largest resident size of a process; writing 5 to `/proc/self/clear_refs` sets that
//! mark back to the present size. So the mark after the build less the size before it is what the build added at its
//! peak, its result included, and the points that were loaded before are not counted.
//! *Trap.* What was allocated and freed before the build may still be resident and be used by it for nothing: load
//! the points without a second copy of them.

use std::time::Instant;

use rustix::time::{ClockId, clock_gettime};

/// What was spent between [`Meter::start`] and [`Meter::stop`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cost {
    /// Processor seconds of the whole process, user and system.
    pub(crate) cpu: f64,
    /// Seconds by the clock.
    pub(crate) wall: f64,
    /// Bytes resident at the peak above those before; `None` where /proc does not tell.
    pub(crate) peak: Option<u64>,
}

/// A measurement that is running.
pub(crate) struct Meter {
    held: Option<u64>,
    cpu: f64,
    wall: Instant,
}

impl Meter {
    /// Begins to measure.
    pub(crate) fn start() -> Self {
        let held =
            std::fs::write("/proc/self/clear_refs", "5").ok().and_then(|()| status("VmRSS:"));
        Meter { held, wall: Instant::now(), cpu: cpu() }
    }

    /// What was spent since. Call it before the result is dropped.
    pub(crate) fn stop(self) -> Cost {
        let cpu = cpu() - self.cpu;
        let wall = self.wall.elapsed().as_secs_f64();
        let peak = self.held.and_then(|held| Some(peak()?.saturating_sub(held)));
        Cost { cpu, wall, peak }
    }
}

/// Processor seconds of this process so far.
fn cpu() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// The largest resident size of this process so far, in bytes; `None` where /proc does not tell.
pub(crate) fn peak() -> Option<u64> {
    status("VmHWM:")
}

/// A size out of `/proc/self/status`, in bytes.
fn status(field: &str) -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(field))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}
