//! The files of [`metadata`](super::metadata) by the requests of MAVLink's file transfer. Stations read them and change
//! none.

use super::demands::Address;
use super::metadata::{self, File};

/// Length of the head of a payload, and of the data after it.
pub(super) const HEAD: usize = 12;
pub(super) const DATA: usize = 239;
/// Parts of a file that answer one request: a flood of requests must not become a greater one of answers.
const BURST: u16 = 8;
/// Open files. One more closes the oldest.
const OPEN_FILES: usize = 16;

/// Opcodes of requests.
mod opcode {
    pub(super) const TERMINATE: u8 = 1;
    pub(super) const RESET: u8 = 2;
    pub(super) const LIST: u8 = 3;
    pub(super) const OPEN: u8 = 4;
    pub(super) const READ: u8 = 5;
    /// The first and the last of those that change files: create, write, remove, folders, truncate, rename.
    pub(super) const CREATE: u8 = 6;
    pub(super) const RENAME: u8 = 13;
    pub(super) const SUM: u8 = 14;
    pub(super) const BURST: u8 = 15;
}
/// The reason of a negative answer, with the numbers of MAV_FTP_ERR.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    NoSuchSession = 4,
    EndOfFile = 6,
    UnknownCommand = 7,
    Protected = 9,
    NotFound = 10,
}

/// A request, as it stands in the payload.
pub(super) struct Request {
    pub(super) sequence: u16,
    pub(super) session: u8,
    pub(super) opcode: u8,
    size: u8,
    offset: u32,
    /// The path, of requests that have one.
    path: String,
}

impl Request {
    pub(super) fn of(payload: &[u8; HEAD + DATA]) -> Self {
        let [a, b, session, opcode, size, _, _, _, c, d, e, f, data @ ..] = payload;
        let data = data.get(..usize::from(*size)).unwrap_or_default();
        let path = data.split(|byte| *byte == 0).next().unwrap_or_default();
        Self {
            sequence: u16::from_le_bytes([*a, *b]),
            session: *session,
            opcode: *opcode,
            size: *size,
            offset: u32::from_le_bytes([*c, *d, *e, *f]),
            path: String::from_utf8_lossy(path).into_owned(),
        }
    }

    /// How much of a file a station wants at a time \[bytes\].
    fn length(&self) -> usize {
        match usize::from(self.size) {
            0 => DATA,
            size => size.min(DATA),
        }
    }
}

/// What a reply says.
pub(super) struct FileReply {
    /// How many replies to this request came before.
    pub(super) number: u16,
    pub(super) offset: u32,
    pub(super) data: Vec<u8>,
    /// Whether it is the last one of a burst.
    pub(super) is_last: bool,
}

impl FileReply {
    pub(super) fn of(data: Vec<u8>) -> Self {
        Self {
            number: 0,
            offset: 0,
            data,
            is_last: false,
        }
    }
}

/// The files, and who has which of them open.
pub(super) struct Files {
    files: [File; 2],
    open: Vec<(Address, u8, usize)>,
}

impl Files {
    pub(super) fn new() -> Self {
        Self {
            files: metadata::files(),
            open: Vec::new(),
        }
    }

    /// The sum of the file that names the others.
    pub(super) fn general_sum(&self) -> u32 {
        let [general, _] = &self.files;
        general.sum()
    }

    /// The replies to a request, or why there is none.
    pub(super) fn answer(
        &mut self,
        request: &Request,
        from: Address,
    ) -> Result<Vec<FileReply>, Refusal> {
        let one = |data| Ok(vec![FileReply::of(data)]);
        match request.opcode {
            opcode::TERMINATE => {
                self.open
                    .retain(|(who, session, _)| (*who, *session) != (from, request.session));
                one(Vec::new())
            }
            opcode::RESET => {
                self.open.retain(|(who, ..)| *who != from);
                one(Vec::new())
            }
            opcode::LIST => Ok(vec![self.list(request)?]),
            opcode::OPEN => {
                let (place, file) = self.find(&request.path)?;
                let length = file.bytes.len() as u32;
                self.keep_open(from, request.session, place);
                one(length.to_le_bytes().to_vec())
            }
            opcode::READ => {
                let file = self.opened(request, from)?;
                Ok(vec![part(file, request, 0)?])
            }
            opcode::BURST => {
                let file = self.opened(request, from)?;
                burst(file, request)
            }
            opcode::SUM => {
                let (_, file) = self.find(&request.path)?;
                one(file.sum().to_le_bytes().to_vec())
            }
            opcode::CREATE..=opcode::RENAME => Err(Refusal::Protected),
            _ => Err(Refusal::UnknownCommand),
        }
    }

    /// The file with a path and its place. All files lie at the top.
    fn find(&self, path: &str) -> Result<(usize, &File), Refusal> {
        let name = path.strip_prefix('/').unwrap_or(path);
        let mut files = self.files.iter().enumerate();
        files
            .find(|(_, file)| file.name == name)
            .ok_or(Refusal::NotFound)
    }

    /// The names and lengths of the files, from the one at the offset on. All of them fit into one answer.
    fn list(&self, request: &Request) -> Result<FileReply, Refusal> {
        if !matches!(request.path.as_str(), "" | "/" | ".") {
            return Err(Refusal::NotFound);
        }
        let rest = self
            .files
            .get(request.offset as usize..)
            .unwrap_or_default();
        if rest.is_empty() {
            return Err(Refusal::EndOfFile);
        }
        let entries = rest
            .iter()
            .map(|file| format!("F{}\t{}\0", file.name, file.bytes.len()));
        Ok(FileReply {
            offset: request.offset,
            ..FileReply::of(entries.collect::<String>().into_bytes())
        })
    }

    fn keep_open(&mut self, from: Address, session: u8, place: usize) {
        self.open
            .retain(|(who, own, _)| (*who, *own) != (from, session));
        if self.open.len() >= OPEN_FILES {
            self.open.remove(0);
        }
        self.open.push((from, session, place));
    }

    fn opened(&self, request: &Request, from: Address) -> Result<&File, Refusal> {
        let mut open = self.open.iter();
        let found = open.find(|(who, session, _)| (*who, *session) == (from, request.session));
        found
            .and_then(|(.., place)| self.files.get(*place))
            .ok_or(Refusal::NoSuchSession)
    }
}

/// The part of a file at the offset of a request, or a later one.
fn part(file: &File, request: &Request, number: u16) -> Result<FileReply, Refusal> {
    let length = request.length();
    let start = (request.offset as usize).saturating_add(usize::from(number) * length);
    let rest = file.bytes.get(start..).unwrap_or_default();
    if rest.is_empty() {
        return Err(Refusal::EndOfFile);
    }
    Ok(FileReply {
        number,
        offset: start as u32,
        ..FileReply::of(rest.iter().take(length).copied().collect())
    })
}

/// Some parts of a file after each other. The station asks for those behind them.
fn burst(file: &File, request: &Request) -> Result<Vec<FileReply>, Refusal> {
    let mut parts = vec![part(file, request, 0)?];
    parts.extend((1..BURST).map_while(|number| part(file, request, number).ok()));
    if let Some(last) = parts.last_mut() {
        last.is_last = true;
    }
    Ok(parts)
}
