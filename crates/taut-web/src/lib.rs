//! The playground in the browser: what the worker of the page in `web/` calls.
//!
//! A [`Session`] holds points, then an answer, then what the checker said of it; each step is a call of its own, so that the page
//! can tell which one is running. Nothing is calculated here: answers, checks, words and pictures are those of the other crates.
//! [`Steps`] shows how an algorithm comes to its answer, one step at a time.
//!
//! The browser ends a module that is out of memory without a word. So a panic is told through `tautPanicked` first, and an end
//! without that is one of memory.
#![forbid(unsafe_code)]

mod input;
mod limits;
mod options;
mod samples;
mod shape;
mod steps;
mod tools;

use taut::Monitor;
use wasm_bindgen::prelude::*;

use crate::input::Opened;
use crate::options::Options;
use crate::shape::Shape;
use crate::tools::Tool;

#[wasm_bindgen]
extern "C" {
    /// Tells the worker that pass number `pass` reads `points` points.
    #[wasm_bindgen(js_name = tautPass)]
    fn told_pass(pass: f64, points: f64);

    /// Tells the worker that `points` more points are done.
    #[wasm_bindgen(js_name = tautPoints)]
    fn told_points(points: f64);

    /// Tells the worker why the module ends.
    #[wasm_bindgen(js_name = tautPanicked)]
    fn told_panic(message: &str);
}

/// Lets the worker know why the module ends, if it has to.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|info| told_panic(&info.to_string())));
}

/// Returns the tools with their options, as JSON.
#[wasm_bindgen]
pub fn tools() -> String {
    tools::schema().to_string()
}

/// Returns the samples, as JSON.
#[wasm_bindgen]
pub fn samples() -> String {
    samples::schema().to_string()
}

/// Points, and what has been found for them.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Session {
    points: Opened,
    shape: Option<Box<dyn Shape>>,
}

#[wasm_bindgen]
impl Session {
    /// Reads the bytes of a file; its name tells the format.
    ///
    /// # Errors
    /// The words of the reader, which name row or line, and value.
    pub fn open(bytes: Vec<u8>, name: &str) -> Result<Session, JsError> {
        Ok(Session { points: Opened::read(bytes, name).map_err(refused)?, shape: None })
    }

    /// Makes the points of a sample that is calculated.
    ///
    /// # Errors
    /// The name is that of no such sample.
    pub fn generate(name: &str) -> Result<Session, JsError> {
        Ok(Session { points: samples::generate(name).map_err(refused)?, shape: None })
    }

    /// Returns name, rows and columns of the points, as JSON.
    pub fn describe(&self) -> String {
        self.points.describe().to_string()
    }

    /// Returns what a tool needs for these points and whether that fits, as JSON.
    ///
    /// # Errors
    /// The name is that of no tool.
    pub fn limit(&self, tool: &str) -> Result<String, JsError> {
        let tool: Tool = tool.parse().map_err(refused)?;
        Ok(limits::of(tool, self.points.source()).to_string())
    }

    /// Finds the shape. `options` is a JSON object of the options that differ from the usual ones.
    ///
    /// # Errors
    /// The words of the solver, or what is wrong with an option.
    pub fn solve(&mut self, tool: &str, options: &str) -> Result<(), JsError> {
        self.shape = None;
        let tool: Tool = tool.parse().map_err(refused)?;
        let options = Options::parse(options).map_err(refused)?;
        let found = tool.solve(&self.points, &options, &watched()).map_err(refused)?;
        self.shape = Some(found);
        Ok(())
    }

    /// Checks the answer with the checker of the command, and returns its words and the report, as JSON.
    ///
    /// # Errors
    /// There is no answer, or the points cannot be read. A refused answer is no error: `verified` is false then.
    pub fn check(&mut self) -> Result<String, JsError> {
        let Session { points, shape } = self;
        let shape = shape.as_mut().ok_or_else(no_answer)?;
        Ok(shape.check(points, &watched()).map_err(refused)?.to_string())
    }

    /// Returns the pictures as one page of HTML.
    ///
    /// # Errors
    /// There is no answer, or no picture of it.
    pub fn picture(&self) -> Result<String, JsError> {
        self.shape()?.picture(&self.points).map_err(refused)
    }

    /// Returns the answer and its certificate as the bytes of JSON, as the command writes it.
    ///
    /// # Errors
    /// There is no answer.
    pub fn json(&self) -> Result<Vec<u8>, JsError> {
        Ok(self.shape()?.json().into_bytes())
    }

    /// Returns the shape as a file of the format that the name tells.
    ///
    /// # Errors
    /// There is no answer, or no such file of it.
    pub fn file(&self, name: &str) -> Result<Vec<u8>, JsError> {
        self.shape()?.file(&self.points, name).map_err(refused)
    }

    /// Shows how the algorithm of a tool comes to its answer.
    ///
    /// # Errors
    /// The tool has no steps for these points.
    pub fn steps(&self, tool: &str, options: &str) -> Result<Steps, JsError> {
        let tool: Tool = tool.parse().map_err(refused)?;
        let options = Options::parse(options).map_err(refused)?;
        Ok(Steps(steps::of(tool, &self.points, &options).map_err(refused)?))
    }
}

impl Session {
    fn shape(&self) -> Result<&dyn Shape, JsError> {
        self.shape.as_deref().ok_or_else(no_answer)
    }
}

/// The steps of an algorithm, each with words and a picture.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Steps(Box<dyn steps::Trace>);

#[wasm_bindgen]
impl Steps {
    /// Returns how many steps there are.
    #[wasm_bindgen(js_name = count)]
    pub fn count(&self) -> usize {
        self.0.count()
    }

    /// Returns the words about step `step`, from 0, as JSON.
    ///
    /// # Errors
    /// There is no such step.
    pub fn words(&self, step: usize) -> Result<String, JsError> {
        Ok(self.0.words(step).map_err(refused)?.to_string())
    }

    /// Returns the picture of step `step` as SVG, so many pixels wide.
    ///
    /// # Errors
    /// There is no such step.
    pub fn picture(&self, step: usize, dark: bool, width: f64) -> Result<String, JsError> {
        let figure = self.0.figure(step).map_err(refused)?;
        Ok(steps::svg(figure, dark, width))
    }
}

/// A monitor that tells the worker; to stop, the page ends the worker.
fn watched() -> Monitor<'static> {
    Monitor {
        on_pass: Some(&|pass, points| told_pass(pass as f64, points as f64)),
        on_points: Some(&|points| told_points(points as f64)),
        cancel: None,
    }
}

fn refused(error: impl std::fmt::Display) -> JsError {
    JsError::new(&error.to_string())
}

fn no_answer() -> JsError {
    JsError::new("there is no answer yet")
}
