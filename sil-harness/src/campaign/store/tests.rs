//! Row files on disks that are full, and files that are none.

use super::*;
use crate::campaign::{Extras, header, run};
use mpp_analysis::campaign::{Campaign, Lists, Shard};
use mpp_sim::scenario::ScenarioFile;
use std::path::PathBuf;
use std::sync::Mutex;

fn short() -> Campaign {
    let scenario = ScenarioFile {
        duration: Some(1.0),
        ..ScenarioFile::default()
    };
    Campaign::new(scenario, Lists::default(), 4, Some(11)).unwrap()
}

fn scratch(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("mpp-store-{}-{name}", std::process::id()))
}

/// A disk with room for so many bytes: what is too much is written in part.
struct Disk {
    bytes: Vec<u8>,
    room: usize,
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = bytes.len().min(self.room - self.bytes.len());
        if count == 0 {
            return Err(ErrorKind::StorageFull.into());
        }
        self.bytes.extend(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Sheet for Disk {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.bytes.truncate(length as usize);
        Ok(())
    }
}

#[test]
fn a_full_disk_keeps_whole_rows_whichever_thread_comes_next() {
    let campaign = short();
    let rows = Mutex::new(Vec::new());
    run(
        &campaign,
        &campaign.jobs(Shard::WHOLE),
        1,
        Extras::HASHED,
        |row| {
            rows.lock().unwrap().push(row);
            Ok(())
        },
    )
    .unwrap();
    let rows = rows.into_inner().unwrap();
    let line = |row: &Row| serde_json::to_string(row).unwrap() + "\n";
    let whole: String = rows[..2].iter().map(line).collect();
    for part in [0, 1, 40, line(&rows[2]).len() - 1] {
        let disk = Disk {
            bytes: Vec::new(),
            room: whole.len() + part,
        };
        let mut file = RowFile::over("rows.jsonl".to_owned(), disk, 0, 0);
        file.push(&rows[0]).unwrap();
        file.push(&rows[1]).unwrap();
        let error = file.push(&rows[2]).unwrap_err();
        assert!(matches!(error, CampaignError::Full(_, 2, _)), "{error}");
        assert!(error.to_string().contains("make room"), "{error}");
        // Somebody makes room; the order of the rows is broken all the same.
        file.sheet.room = usize::MAX;
        let error = file.push(&rows[3]).unwrap_err();
        assert!(matches!(error, CampaignError::Full(_, 2, _)), "{error}");
        assert_eq!(String::from_utf8(file.sheet.bytes).unwrap(), whole);
    }
}

/// By the start of its flights a row file knows the program that flew them. Most of these faults begin later.
#[test]
fn every_named_fault_has_a_header() {
    let faults = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/scenarios/faults");
    let mut count = 0;
    for file in std::fs::read_dir(faults).unwrap() {
        let path = file.unwrap().path();
        let scenario = crate::files::read_scenario(&path).unwrap();
        let campaign = Campaign::new(scenario, Lists::default(), 1, None).unwrap();
        let header = header(campaign, Shard::WHOLE);
        assert!(header.is_ok(), "{}: {header:?}", path.display());
        count += 1;
    }
    assert!(count > 30);
}

#[test]
fn a_file_that_is_none_of_ours_is_refused_and_left_as_it_was() {
    let header = header(short(), Shard::WHOLE).unwrap();
    let path = scratch("foreign");
    let own = serde_json::to_vec(&header).unwrap();
    for foreign in [&b"{\"schema\":2"[..], b"a poem", b"\xff\xfe", b"\xff\n\xfe"] {
        std::fs::write(&path, foreign).unwrap();
        let error = RowFile::open(&path, &header).unwrap_err();
        assert!(matches!(error, CampaignError::NoRowFile(_)), "{error}");
        assert_eq!(std::fs::read(&path).unwrap(), foreign);
    }
    // A torn header of this campaign is gone on with.
    for cut in [0, 1, own.len() / 2, own.len()] {
        std::fs::write(&path, &own[..cut]).unwrap();
        RowFile::open(&path, &header).unwrap();
        assert_eq!(std::fs::read(&path).unwrap().len(), own.len() + 1);
    }
    std::fs::remove_file(&path).unwrap();
    let error = RowFile::open(&std::env::temp_dir(), &header).unwrap_err();
    assert!(matches!(error, CampaignError::NoFile(_)), "{error}");
}
