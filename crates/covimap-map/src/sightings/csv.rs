//! CSV: a header that names the columns `step` and `landmark`, then one sighting a row.
//!
//! Rows of one step follow each other; a step that comes back later is an error, because two
//! half steps would make two landmarks look apart that were seen together. The values of `step`
//! are names, not numbers: they need not ascend. The reader keeps every one of them until the end
//! of the file, some 30 bytes a step.
//!
//! A row is one line: a quoted field must not run over a line end, so that one missing quote is
//! found on its line and does not swallow the rest of the file. White space around a field is no
//! part of it.

use std::borrow::Cow;

use super::interner::{Interner, NameHash};
use super::lines::{check_id, excerpt};
use super::tokens::LogBuilder;
use crate::LandmarkId;

/// The rows of one file, up to the present one.
#[derive(Debug, Default)]
pub(super) struct Rows {
    header: Header,
    steps: Interner,
    /// The step that the last row belongs to.
    step: Option<LandmarkId>,
}

#[derive(Debug, Default)]
enum Header {
    #[default]
    Awaited,
    /// Nothing can be made of the rows.
    Refused,
    Columns {
        step: usize,
        landmark: usize,
        width: usize,
    },
}

impl Rows {
    /// Reads one line into `log`.
    pub(super) fn line(&mut self, line: &str, log: &mut LogBuilder) -> Result<(), String> {
        if line.trim_ascii().is_empty() {
            return Ok(());
        }
        match self.header {
            Header::Refused => Ok(()),
            Header::Awaited => {
                self.header = Header::Refused;
                self.header = read_header(line)?;
                Ok(())
            }
            Header::Columns { step, landmark, width } => {
                let [step, landmark] = pick(line, [step, landmark], width)?;
                check_id(&landmark)?;
                self.enter(&step, log)?;
                log.push_sighting(&landmark);
                Ok(())
            }
        }
    }

    /// Ends the last step.
    pub(super) fn end(self, log: &mut LogBuilder) {
        if self.step.is_some() {
            log.end_step();
        }
    }

    /// Goes on with a step or begins a new one.
    fn enter(&mut self, step: &str, log: &mut LogBuilder) -> Result<(), String> {
        if self.step.is_some_and(|last| self.steps.names().name(last) == step) {
            return Ok(());
        }
        if step.is_empty() {
            return Err("the step is empty; every row needs a step and a landmark".into());
        }
        let hash = NameHash::of(step);
        if self.steps.find(hash, step).is_some() {
            return Err(format!(
                "step {} has rows further up, with other steps between; rows of one step must be \
                 contiguous, sort the file by step",
                excerpt(step)
            ));
        }
        if self.step.is_some() {
            log.end_step();
        }
        self.step = Some(LandmarkId(self.steps.intern(hash, step)));
        Ok(())
    }
}

fn read_header(line: &str) -> Result<Header, String> {
    let fields = fields(line)?;
    let column = |name: &str| fields.iter().position(|field| field == name);
    match (column("step"), column("landmark")) {
        (Some(step), Some(landmark)) => Ok(Header::Columns { step, landmark, width: fields.len() }),
        _ => Err(format!(
            "the header must name the columns `step` and `landmark`, but the first line is {}; put \
             `step,landmark` in front, with a comma between",
            excerpt(line.trim_ascii())
        )),
    }
}

/// Two fields of a row of `width` fields.
fn pick(line: &str, columns: [usize; 2], width: usize) -> Result<[Cow<'_, str>; 2], String> {
    let mut fields = fields(line)?;
    if fields.len() != width {
        let found = fields.len();
        return Err(format!("the row has {found} fields, the header has {width}; give every row {width}"));
    }
    Ok(columns.map(|column| std::mem::take(&mut fields[column])))
}

/// All fields of a row.
fn fields(line: &str) -> Result<Vec<Cow<'_, str>>, String> {
    if !line.contains('"') {
        return Ok(line.split(',').map(|field| Cow::Borrowed(field.trim_ascii())).collect());
    }
    if line.matches('"').count() % 2 == 1 {
        return Err("a quoted field is not closed on its line; close the quote, or double it if it is part \
                    of the text"
            .into());
    }
    let mut reader =
        csv::ReaderBuilder::new().has_headers(false).trim(csv::Trim::All).from_reader(line.as_bytes());
    let mut record = csv::StringRecord::new();
    reader.read_record(&mut record).map_err(|error| format!("the row cannot be taken apart: {error}"))?;
    Ok(record.iter().map(|field| Cow::Owned(field.to_owned())).collect())
}
