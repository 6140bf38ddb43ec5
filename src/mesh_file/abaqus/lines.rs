//! The lines of a deck, those of included files in place of `*INCLUDE`.

use crate::error::Error;

/// Most files of one deck: two includes of the same file in each of n files are 2ⁿ files.
const MOST_FILES: usize = 1000;

/// Most files that include each other: each takes room on the stack.
const MOST_DEEP: usize = 50;

/// Gives the bytes of an included file, whose name stands as in the deck.
pub(crate) type Reader<'a> = dyn Fn(&str) -> Result<Vec<u8>, Error> + 'a;

/// A line that is neither empty nor a comment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line<'a> {
    /// Without the blanks around it.
    pub(crate) text: &'a str,
    /// File that it stands in.
    pub(crate) file: &'a str,
    /// Its number there, from 1.
    pub(crate) number: usize,
}

impl Line<'_> {
    /// What is wrong in this line.
    pub(crate) fn error(&self, reason: impl Into<String>) -> Error {
        Error::Mesh {
            file: self.file.to_owned(),
            line: self.number,
            reason: reason.into(),
        }
    }

    /// Whether a keyword stands here.
    pub(super) fn is_keyword(&self) -> bool {
        self.text.starts_with('*')
    }
}

/// Where a line stands: its file and number, first and last byte.
struct Span {
    file: usize,
    number: usize,
    bytes: std::ops::Range<usize>,
}

/// All files of a deck, and their lines in reading order.
#[derive(Default)]
pub(crate) struct Source {
    files: Vec<(String, String)>,
    spans: Vec<Span>,
}

impl Source {
    /// Reads a deck from bytes and what it includes through `read`; `name` stands for it in messages.
    pub(crate) fn new(bytes: &[u8], name: &str, read: &Reader<'_>) -> Result<Self, Error> {
        let mut source = Self::default();
        source.append(bytes, name, read, &mut Vec::new())?;
        Ok(source)
    }

    /// The lines in reading order.
    pub(super) fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        self.spans.iter().map(|span| self.line(span))
    }

    fn line(&self, span: &Span) -> Line<'_> {
        let (file, text) = &self.files[span.file];
        Line {
            text: &text[span.bytes.clone()],
            file,
            number: span.number,
        }
    }

    /// Appends a file; `open` are the files that include it.
    fn append(
        &mut self,
        bytes: &[u8],
        name: &str,
        read: &Reader<'_>,
        open: &mut Vec<String>,
    ) -> Result<(), Error> {
        // Comments come in any encoding; names that are no UTF-8 stay told apart well enough.
        let text = String::from_utf8_lossy(bytes).into_owned();
        let file = self.files.len();
        let spans = spans(file, &text);
        self.files.push((name.to_owned(), text));
        open.push(name.to_owned());
        let mut spans = spans.into_iter().peekable();
        while let Some(span) = spans.next() {
            let Some(mut keyword) = include(self.line(&span).text) else {
                self.spans.push(span);
                continue;
            };
            while keyword.trim_end().ends_with(',') {
                let Some(next) = spans.next() else { break };
                keyword.push_str(self.line(&next).text);
            }
            let included = self.target(&span, &keyword, open)?;
            let line = self.line(&span);
            let bytes = read(&included)
                .map_err(|error| error.within(line.error(format!("*INCLUDE of `{included}`"))))?;
            self.append(&bytes, &included, read, open)?;
        }
        open.pop();
        Ok(())
    }

    /// The file that an include names.
    fn target(&self, span: &Span, keyword: &str, open: &[String]) -> Result<String, Error> {
        let line = self.line(span);
        let parameter = keyword.split(',').skip(1).find_map(|parameter| {
            let (key, value) = parameter.split_once('=')?;
            let value = value.trim().trim_matches('"');
            (key.trim().eq_ignore_ascii_case("input") && !value.is_empty()).then_some(value)
        });
        let Some(included) = parameter else {
            return Err(line.error("*INCLUDE: expected `INPUT=` and a file name"));
        };
        if open.iter().any(|file| file == included) {
            return Err(line.error(format!(
                "*INCLUDE: `{included}` includes itself: {}",
                open.join(" → ")
            )));
        }
        if self.files.len() >= MOST_FILES || open.len() >= MOST_DEEP {
            return Err(line.error(format!(
                "*INCLUDE: more than {MOST_FILES} files, or {MOST_DEEP} inside each other"
            )));
        }
        Ok(included.to_owned())
    }
}

/// The lines of a text that are neither empty nor comments.
fn spans(file: usize, text: &str) -> Vec<Span> {
    let mut spans = Vec::new();
    let mut start = 0;
    for (number, line) in (1..).zip(text.split('\n')) {
        let blank = |c: char| c.is_whitespace() || c == '\u{feff}' || c == '\0';
        let kept = line.trim_matches(blank);
        if !kept.is_empty() && !kept.starts_with("**") {
            let from = start + (line.len() - line.trim_start_matches(blank).len());
            spans.push(Span {
                file,
                number,
                bytes: from..from + kept.len(),
            });
        }
        start += line.len() + 1;
    }
    spans
}

/// The line, if it is an `*INCLUDE`.
fn include(text: &str) -> Option<String> {
    let name = text.strip_prefix('*')?.split(',').next()?.trim();
    (name.eq_ignore_ascii_case("include")).then(|| text.to_owned())
}
