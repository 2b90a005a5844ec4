// The flight is made in a worker, so that a planning cycle never holds up a picture. Its code is that of these functions.

function serve() {
  onmessage = async ({ data: { id, packed, question } }) => {
    try {
      if (packed) module = (await unpack(packed)).instance.exports;
      const bytes = question && askBytes(question);
      postMessage({ id, answer: question && (question.ask === "bytes" ? bytes : JSON.parse(textOf(bytes))) });
    } catch (error) {
      postMessage({ id, error: error.message || String(error) });
    }
  };
}

// Questions that wait for their answer.
const waiting = new Map();
let worker = null, asked = 0;

function hire() {
  const source = ["let module = null;", textOf, askBytes, unpack, serve, "serve();"].join("\n");
  worker = new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
  worker.onmessage = ({ data: { id, answer, error } }) => {
    const [done, failed] = waiting.get(id);
    waiting.delete(id);
    if (error) failed(new Error(error)); else done(answer);
  };
  worker.onerror = event => { for (const [, failed] of waiting.values()) failed(new Error(event.message || "the worker stopped")); };
}

// Sends something to the worker. The answer comes later.
function send(what) {
  return new Promise((done, failed) => {
    waiting.set(++asked, [done, failed]);
    worker.postMessage({ id: asked, ...what });
  });
}

const inquire = question => send({ question });
