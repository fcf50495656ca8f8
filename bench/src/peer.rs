//! Peers as processes: each reads its input once, then solves once per line it is sent.
//!
//! So taut and its peers take turns within one run of the bench, a peer that crashes takes nothing with it, and one
//! that is too slow is stopped. The protocol is written down in `peers/protocol.hpp`.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};

use miniball::{Ball, Enclosing};
use nalgebra::{Const, OPoint};
use serde::{Deserialize, Serialize, Serializer};

use crate::prelude::*;

/// The time a peer is given to read its input and build its own points of it.
const LOADING_TIME_MAX: Duration = Duration::from_secs(120);

/// One answer of a peer.
#[derive(Clone, Debug)]
pub(crate) struct Answer {
    /// Seconds of the solver alone.
    pub(crate) seconds: f64,
    /// The radius it claims.
    pub(crate) radius: f64,
    /// The center it claims, or what its answer is made of instead.
    pub(crate) center: Vec<f64>,
    /// Points it says determine the answer; 0 where it does not tell.
    pub(crate) support: u64,
}

/// A peer that has its input in memory.
pub(crate) struct Peer {
    child: Child,
    stdin: ChildStdin,
    lines: Receiver<String>,
    center: PathBuf,
}

/// Why a peer gave no answer.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Silence {
    /// `bench/setup` did not get it.
    NotInstalled,
    /// It was stopped after this long.
    Slow(Duration),
    /// It ended on its own.
    Ended,
}

impl std::fmt::Display for Silence {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Silence::NotInstalled => write!(f, "not installed: run bench/setup"),
            Silence::Slow(limit) => write!(f, "no answer in {} s", limit.as_secs()),
            Silence::Ended => write!(f, "ended without an answer"),
        }
    }
}

impl Serialize for Silence {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// The folder `bench` of the repository this program was built from.
pub(crate) fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Peers by the beginnings of their names: the Python package of a script, or nothing for a program of `peers/build`,
/// then the script or program and its argument. NAME stands for the name of the peer, REST for what follows the beginning.
/// A name that is not here is that of a program, with its build (`fgk-native`, `cgal-spheres-3-o2`).
const PEERS: &[(&str, &str, &str)] = &[
    ("cyminiball", "cyminiball", "pypi.py NAME"),
    ("miniball-pypi", "miniball", "pypi.py miniball"),
    ("sklearn-mcd-", "sklearn", "mcd.py REST"),
    ("one-class-", "sklearn", "recognize.py REST"),
    ("classify-", "sklearn", "classifiers.py REST"),
    ("opencv-", "cv2", "hands.py REST"),
    ("imageproc", "", "rust/release/peers NAME"),
    ("conic-", "cvxpy", "conic.py REST"),
    ("set-cover", "highspy", "centers.py NAME"),
    ("medoids", "sklearn_extra.cluster", "centers.py NAME"),
    ("traversal-", "numpy", "centers.py NAME"),
    ("elkai", "elkai", "tours.py NAME"),
    ("plain-curve", "scipy", "plain_curve.py 4"),
    ("dynesty", "dynesty", "bounding.py"),
    ("mic-shapely", "shapely", "inscribe.py NAME"),
    ("mic-polylabel", "polylabel", "inscribe.py NAME"),
    ("parry3d-pairs", "", "rust/release/peers NAME"),
    ("polylabel-crate", "", "rust/release/peers NAME"),
    ("solid-iris", "pydrake", "inscribe.py NAME"),
    ("solid-parry3d", "igl", "inscribe.py NAME"),
    ("solid-vhacd", "vhacdx", "inscribe.py NAME"),
    ("solid-coacd", "coacd", "inscribe.py NAME"),
    ("open3d-", "open3d", "surface.py NAME"),
    ("pymeshlab-", "pymeshlab", "surface.py NAME"),
    ("cgal-hilbert-2-", "", "cgal-hilbert-2 REST"),
    ("cgal-hilbert-3-", "", "cgal-hilbert-3 REST"),
    ("cgal-approximate-", "", "cgal-approximate-ellipsoid REST"),
    ("cgal-transport-", "", "cgal-transport REST"),
    ("cgal-surface-", "", "cgal-surface REST"),
    ("concorde", "", "tours/release/tours"),
    ("quickheap", "", "rust/release/peers NAME"),
    ("", "", "NAME"),
];

/// How a peer is called; `None` when it is not installed.
fn command(name: &str) -> Result<Option<Command>> {
    if name == "miniball-crate" {
        let mut command = Command::new(std::env::current_exe()?);
        command.arg("peer-crate");
        return Ok(Some(command));
    }
    if name.starts_with("numpy-sort") {
        return Ok(sorter(name));
    }
    let found = PEERS.iter().find_map(|(start, package, words)| {
        Some((name.strip_prefix(start)?, *package, words.split(' ')))
    });
    let (rest, package, mut words) = found.with_context(|| name.to_owned())?;
    let program = words.next().unwrap_or_default().replace("NAME", name);
    let arguments = words.map(|word| word.replace("NAME", name).replace("REST", rest));
    let mut command = match package {
        "" => Command::new(folder().join("peers/build").join(program)),
        package => {
            let mut command = Command::new(folder().join(".venv/bin/python"));
            let import = format!("import {package}");
            let status = command.args(["-c", &import]).stderr(Stdio::null()).status();
            if !status.is_ok_and(|status| status.success()) {
                return Ok(None);
            }
            command = Command::new(command.get_program());
            // Libraries below Python start threads of their own.
            command.env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1");
            command.arg(folder().join("peers").join(program));
            command
        }
    };
    command.args(arguments);
    Ok(Path::new(command.get_program()).exists().then_some(command))
}

/// numpy of its own folder, as other packages want an older one; `-avx2` keeps it from longer vectors.
fn sorter(name: &str) -> Option<Command> {
    let [numpy, interpreter] =
        ["peers/build/numpy", ".venv/bin/python"].map(|path| folder().join(path));
    (numpy.exists() && interpreter.exists()).then(|| {
        let mut command = Command::new(interpreter);
        command.arg(folder().join("peers/sort.py")).env("PYTHONPATH", numpy);
        if name.ends_with("-avx2") {
            command.env("NPY_DISABLE_CPU_FEATURES", "X86_V4 AVX512_ICL AVX512_SPR");
        }
        command
    })
}

impl Peer {
    /// Starts the peer `name` on `input`; files it writes go to `scratch`.
    pub(crate) fn start(name: &str, input: &Path, scratch: &Path) -> Result<Result<Peer, Silence>> {
        let Some(mut command) = command(name)? else { return Ok(Err(Silence::NotInstalled)) };
        let center = scratch.join(format!("{name}.center"));
        let mut child = command
            .arg(input)
            .arg(&center)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .with_context(|| name.to_owned())?;
        let (Some(stdin), Some(stdout)) = (child.stdin.take(), child.stdout.take()) else {
            bail!("{name}: no pipes");
        };
        let (send, lines) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                if send.send(line).is_err() {
                    break;
                }
            }
        });
        let mut peer = Peer { child, stdin, lines, center };
        Ok(peer.line(LOADING_TIME_MAX).map(|_| peer))
    }

    /// Lets the peer solve once more.
    pub(crate) fn solve(&mut self, limit: Duration) -> Result<Result<Answer, Silence>> {
        #[derive(Deserialize)]
        struct Line {
            seconds: f64,
            radius: Option<f64>,
            #[serde(default)]
            support: u64,
        }
        if self.stdin.write_all(b"run\n").and_then(|()| self.stdin.flush()).is_err() {
            return Ok(Err(Silence::Ended));
        }
        let text = match self.line(limit) {
            Ok(text) => text,
            Err(silence) => return Ok(Err(silence)),
        };
        // C prints NaN as a bare word, which is not JSON: such a radius is read as none.
        let text = text.replace("-nan", "null").replace("nan", "null").replace("inf", "null");
        let line: Line = serde_json::from_str(&text).with_context(|| text.clone())?;
        let bytes = std::fs::read(&self.center)?;
        let center = doubles(&bytes);
        let radius = line.radius.unwrap_or(f64::NAN);
        Ok(Ok(Answer { seconds: line.seconds, radius, center, support: line.support }))
    }

    fn line(&mut self, limit: Duration) -> Result<String, Silence> {
        self.lines.recv_timeout(limit).map_err(|error| match error {
            RecvTimeoutError::Timeout => Silence::Slow(limit),
            RecvTimeoutError::Disconnected => Silence::Ended,
        })
    }
}

/// Lets a peer answer so many times about rows: its answers, and why there are no more.
pub(crate) fn ask_often(
    context: &Context,
    name: &str,
    (values, columns): (&[f64], usize),
    times: usize,
) -> Result<(Vec<Answer>, Option<Silence>)> {
    let file = context.file("rows");
    write_rows(&file, values, columns)?;
    let mut running = match Peer::start(name, &file, context.temp.path())? {
        Ok(running) => running,
        Err(silence) => return Ok((vec![], Some(silence))),
    };
    let mut answers = Vec::new();
    for _ in 0..times {
        match running.solve(context.limit)? {
            Ok(answer) => answers.push(answer),
            Err(silence) => return Ok((answers, Some(silence))),
        }
    }
    Ok((answers, None))
}

/// Lets a peer answer once about rows.
pub(crate) fn ask(
    context: &Context,
    name: &str,
    rows: (&[f64], usize),
) -> Result<Result<Answer, Silence>> {
    let (mut answers, silence) = ask_often(context, name, rows, 1)?;
    Ok(answers.pop().ok_or(silence.unwrap_or(Silence::Ended)))
}

impl Drop for Peer {
    fn drop(&mut self) {
        // It may still be at work; an error means that it has ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Little-endian doubles; bytes beyond the last whole one are none.
fn doubles(bytes: &[u8]) -> Vec<f64> {
    let (whole, _) = bytes.as_chunks::<8>();
    whole.iter().map(|&bytes| f64::from_le_bytes(bytes)).collect()
}

/// Serves the crate `miniball`, whose dimension is fixed when it is compiled.
pub(crate) fn serve_crate(input: &Path, center: &Path) -> Result<()> {
    let bytes = std::fs::read(input)?;
    ensure!(bytes.len() >= 16, "{}: no header of rows and columns", input.display());
    let (head, values) = bytes.split_at(16);
    let columns = u64::from_le_bytes(head[8..].try_into()?);
    let values = doubles(values);
    // A macro, as the bounds of a function generic in the dimension would be longer than its body.
    macro_rules! serve {
        ($($dim:literal)*) => {
            match columns {
                $($dim => serve_points::<OPoint<f64, Const<$dim>>>(
                    values.chunks_exact($dim).map(OPoint::<f64, Const<$dim>>::from_slice).collect(),
                    center,
                    |points| {
                        let ball = Ball::enclosing_points(points);
                        (ball.center.coords.as_slice().to_vec(), ball.radius_squared.sqrt())
                    },
                ),)*
                _ => bail!("the crate miniball was compiled for other dimensions than {columns}"),
            }
        };
    }
    serve!(2 3 10)
}

fn serve_points<P: Clone>(
    points: VecDeque<P>,
    path: &Path,
    solve: impl Fn(&mut VecDeque<P>) -> (Vec<f64>, f64),
) -> Result<()> {
    println!("{{\"ready\":true}}");
    for line in std::io::stdin().lines() {
        line?;
        // It moves support points to the front, which would make a second run on the same list a different one.
        let mut points = points.clone();
        let start = Instant::now();
        let (center, radius) = solve(&mut points);
        let seconds = start.elapsed().as_secs_f64();
        std::fs::write(path, bytemuck::cast_slice(&center))?;
        println!("{{\"seconds\":{seconds},\"radius\":{radius}}}");
    }
    Ok(())
}
