//! A headless Chromium, asked over pipes in its own protocol (chromedevtools.github.io/devtools-protocol).

use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread::spawn;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;

/// The browser has ended or hangs if it says nothing for so long: machines of tests are slow and shared.
const SILENCE_MAX: Duration = Duration::from_secs(180);

/// A browser that has not closed by then is ended.
const CLOSING_MAX: Duration = Duration::from_secs(5);

/// A browser with one page.
pub(super) struct Browser {
    process: Child,
    commands: File,
    messages: Receiver<Value>,
    session: Option<String>,
    last: u64,
    /// The events that nobody has waited for yet.
    events: Vec<Value>,
    folder: TempDir,
}

/// A way to look at a page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Screen {
    pub(super) width: u32,
    pub(super) dark: bool,
    pub(super) print: bool,
}

/// Finds the browser that the variable CHROMIUM names, else the first of the usual ones that is installed.
fn find_browser() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("CHROMIUM") {
        return Some(named.into());
    }
    let folders = std::env::var_os("PATH").unwrap_or_default();
    let names = ["google-chrome", "chromium", "chromium-browser"];
    let places = |name| std::env::split_paths(&folders).map(move |folder| folder.join(name));
    // A browser in a snap sees no folder of temporary files.
    let is_free = |path: &PathBuf| {
        path.canonicalize()
            .is_ok_and(|path| !path.components().any(|part| part.as_os_str() == "snap"))
    };
    names.into_iter().flat_map(places).find(|path| path.is_file() && is_free(path))
}

impl Browser {
    /// Starts a browser; `None` where there is none.
    pub(super) fn start() -> Option<Browser> {
        let program = find_browser()?;
        let folder = TempDir::new().unwrap();
        let [commands, answers] = ["commands", "answers"].map(|name| folder.path().join(name));
        assert!(Command::new("mkfifo").args([&commands, &answers]).status().unwrap().success());
        // The browser reads commands from its third file and answers to its fourth.
        let process = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<commands 4>answers"])
            .arg(program)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"])
            .args(["--disable-dev-shm-usage", "--no-first-run", "--user-data-dir=profile"])
            .arg("--remote-debugging-pipe")
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .stderr(File::create(folder.path().join("stderr")).unwrap())
            .spawn()
            .unwrap();
        let commands = File::options().write(true).open(commands).unwrap();
        let mut answers = BufReader::new(File::open(answers).unwrap());
        let (sender, messages) = channel();
        spawn(move || {
            let mut text = Vec::new();
            while answers.read_until(0, &mut text).is_ok_and(|read| read > 0) {
                text.pop();
                let Ok(message) = serde_json::from_slice(&text) else { break };
                if sender.send(message).is_err() {
                    break;
                }
                text.clear();
            }
        });
        let (last, events, session) = (0, Vec::new(), None);
        let mut browser = Browser { process, commands, messages, session, last, events, folder };
        let target = browser.ask("Target.createTarget", json!({ "url": "about:blank" }));
        let target = json!({ "targetId": target["targetId"], "flatten": true });
        let session = browser.ask("Target.attachToTarget", target);
        browser.session = session["sessionId"].as_str().map(str::to_owned);
        browser.ask("Page.enable", json!({}));
        browser.ask("Runtime.enable", json!({}));
        Some(browser)
    }

    fn message(&mut self) -> Value {
        self.messages.recv_timeout(SILENCE_MAX).unwrap_or_else(|error| {
            let said = std::fs::read_to_string(self.folder.path().join("stderr"));
            panic!("the browser does not answer: {error}; {}", said.unwrap_or_default())
        })
    }

    /// Sends a command, and returns its result.
    fn ask(&mut self, method: &str, parameters: Value) -> Value {
        self.last += 1;
        let mut command = json!({ "id": self.last, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            command["sessionId"] = json!(session);
        }
        let mut bytes = command.to_string().into_bytes();
        bytes.push(0);
        self.commands.write_all(&bytes).unwrap();
        loop {
            let mut message = self.message();
            if message["id"] == json!(self.last) {
                assert!(message.get("error").is_none(), "{method}: {message}");
                return message["result"].take();
            }
            self.events.push(message);
        }
    }

    fn wait_for(&mut self, event: &str) {
        while !self.events.iter().any(|message| message["method"] == event) {
            let message = self.message();
            self.events.push(message);
        }
    }

    /// Opens a page, and waits until it is drawn.
    pub(super) fn open(&mut self, page: &Path) {
        self.events.clear();
        let url = format!("file://{}", page.display());
        let found = self.ask("Page.navigate", json!({ "url": url }));
        assert!(found.get("errorText").is_none(), "{url}: {found}");
        self.wait_for("Page.loadEventFired");
        // The event may be that of the page before.
        self.evaluate(
            "new Promise((done) => document.readyState === \"complete\" ? done(0) : addEventListener(\"load\", () => done(0)))",
        );
        self.evaluate("document.fonts.ready.then(() => 0)");
    }

    /// Looks at the page in another way, and waits until it is drawn.
    pub(super) fn show_on(&mut self, Screen { width, dark, print }: Screen) {
        let size =
            json!({ "width": width, "height": 800, "deviceScaleFactor": 1, "mobile": false });
        self.ask("Emulation.setDeviceMetricsOverride", size);
        let scheme = if dark { "dark" } else { "light" };
        let emulated = json!({
            "media": if print { "print" } else { "screen" },
            "features": [{ "name": "prefers-color-scheme", "value": scheme }],
        });
        self.ask("Emulation.setEmulatedMedia", emulated);
        let frame = "new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(() => drawn(0))))";
        self.evaluate(frame);
    }

    /// The value of an expression of the page, a promise for it or not.
    pub(super) fn evaluate(&mut self, expression: &str) -> Value {
        let how = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let mut found = self.ask("Runtime.evaluate", how);
        assert!(found.get("exceptionDetails").is_none(), "{found}");
        found["result"]["value"].take()
    }

    /// The whole page of so many pixels as a PNG in base 64, `scale` pixels to each.
    pub(super) fn screenshot(&mut self, [width, height]: [f64; 2], scale: f64) -> String {
        let clip = json!({ "x": 0, "y": 0, "width": width, "height": height, "scale": scale });
        let how = json!({ "format": "png", "captureBeyondViewport": true, "clip": clip });
        self.ask("Page.captureScreenshot", how)["data"].as_str().unwrap().to_owned()
    }

    /// Lists the exceptions that scripts threw since the page was opened.
    pub(super) fn exceptions(&self) -> Vec<&Value> {
        self.events
            .iter()
            .filter(|message| message["method"] == "Runtime.exceptionThrown")
            .collect()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Its helpers write to the folder until they end, too.
        let _ = self.commands.write_all(b"{\"id\":0,\"method\":\"Browser.close\"}\0");
        let begin = Instant::now();
        while matches!(self.process.try_wait(), Ok(None)) && begin.elapsed() < CLOSING_MAX {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
