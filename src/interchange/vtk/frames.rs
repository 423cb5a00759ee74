//! VTK as a process that renders an exported scene frame after frame.

use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde::Deserialize;

use crate::error::{Error, Fault, Result};

/// VTK's renderers of volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mapper {
    /// By OpenGL.
    Gpu,
    /// The fixed-point mapper; transfer functions of the value alone.
    Cpu,
}

impl Mapper {
    /// As the script calls it.
    pub fn name(self) -> &'static str {
        match self {
            Mapper::Gpu => "gpu",
            Mapper::Cpu => "cpu",
        }
    }
}

/// The user's Python with the script of an exported scene. Its first frame, in which VTK prepares what it keeps, is over once
/// it has started.
#[derive(Debug)]
pub struct Frames {
    python: PathBuf,
    process: Child,
    requests: Option<ChildStdin>,
    answers: BufReader<ChildStdout>,
    /// VTK's version.
    pub version: String,
}

#[derive(Deserialize)]
struct Started {
    vtk: String,
}

#[derive(Deserialize)]
struct Frame {
    seconds: f64,
}

impl Frames {
    /// Starts the script that [`export`](super::export) wrote, and waits for the first frame.
    ///
    /// # Errors
    /// `Fault::Input` if Python cannot be run, or makes no picture.
    pub fn start(python: &Path, script: &Path, mapper: Mapper, threads: usize) -> Result<Self> {
        let mut process = Command::new(python)
            .arg(script)
            .args(["--frames", "--mapper", mapper.name(), "--threads", &threads.to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|cause| {
                Error::new(Fault::Input, "Python cannot be run").at(python).remedy(super::REMEDY).caused_by(cause)
            })?;
        let requests = process.stdin.take();
        let Some(answers) = process.stdout.take() else {
            return Err(Error::new(Fault::Internal, "a process without the pipe that was asked for").at(python));
        };
        let answers = BufReader::new(answers);
        let mut frames = Frames { python: python.to_owned(), process, requests, answers, version: String::new() };
        frames.version = frames.answer::<Started>()?.vtk;
        Ok(frames)
    }

    /// Seconds of a frame with samples this far apart; where told, it is written as `.npy` or `.png`.
    ///
    /// # Errors
    /// `Fault::Input` if VTK makes no picture.
    pub fn seconds(&mut self, step_mm: f64, output: Option<&Path>) -> Result<f64> {
        let output = output.map_or(String::new(), |path| format!(" {}", path.display()));
        let sent = self.requests.as_mut().map(|requests| writeln!(requests, "{step_mm}{output}"));
        match sent {
            Some(Ok(())) => Ok(self.answer::<Frame>()?.seconds),
            _ => Err(self.stopped()),
        }
    }

    fn answer<T: for<'de> Deserialize<'de>>(&mut self) -> Result<T> {
        let mut line = String::new();
        match self.answers.read_line(&mut line) {
            Ok(length) if length > 0 => serde_json::from_str(&line).map_err(|cause| {
                Error::new(Fault::Input, "VTK's script said what is no answer").at(&self.python).caused_by(cause)
            }),
            _ => Err(self.stopped()),
        }
    }

    /// What the process said last.
    fn stopped(&mut self) -> Error {
        let mut said = String::new();
        if let Some(stderr) = self.process.stderr.as_mut() {
            // Without its last words the error still says what happened.
            let _ = stderr.read_to_string(&mut said);
        }
        let last = said.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("nothing").to_owned();
        Error::new(Fault::Input, "VTK made no picture").at(&self.python).found(last).remedy(super::REMEDY)
    }
}

impl Drop for Frames {
    /// Ends the process, which reads to the end of what it is asked.
    fn drop(&mut self) {
        drop(self.requests.take());
        // It may have ended before; then there is nothing to end.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_python_that_is_not_there_is_named() {
        let error = Frames::start(Path::new("no-such-python"), Path::new("render.py"), Mapper::Cpu, 1)
            .expect_err("there is no such program");
        assert_eq!(error.fault(), Fault::Input);
        assert!(error.to_string().contains("no-such-python"), "found {error}");
    }

    #[test]
    fn a_script_that_stops_is_an_error_with_its_last_words() {
        // `true` reads no script and says nothing.
        let error = Frames::start(Path::new("true"), Path::new("render.py"), Mapper::Gpu, 1).expect_err("no answer");
        assert!(error.to_string().contains("VTK made no picture"), "found {error}");
    }
}
