//! What a module exports.

#![expect(
    unsafe_code,
    reason = "the names of exports and the clock are outside of the compiler's sight"
)]

use super::Desk;
use std::cell::RefCell;

#[link(wasm_import_module = "env")]
unsafe extern "C" {
    #[link_name = "clock"]
    safe fn clock() -> f64;
}

thread_local! {
    static QUESTION: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static DESK: RefCell<Desk> = RefCell::new(Desk::new(|| clock()));
}

/// Makes room for a question of so many bytes, and gives its place.
#[unsafe(no_mangle)]
extern "C" fn question(length: usize) -> *mut u8 {
    QUESTION.with_borrow_mut(|question| {
        question.clear();
        question.resize(length, 0);
        question.as_mut_ptr()
    })
}

/// Answers the question. Returns the answer's length.
#[unsafe(no_mangle)]
extern "C" fn ask() -> usize {
    let answer =
        QUESTION.with_borrow(|question| DESK.with_borrow_mut(|desk| desk.answer(question)));
    ANSWER.replace(answer);
    ANSWER.with_borrow(Vec::len)
}

/// The place of the answer.
#[unsafe(no_mangle)]
extern "C" fn answer() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}
