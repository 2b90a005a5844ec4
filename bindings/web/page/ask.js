// How a page unpacks its module and asks it.

// Asks the module and returns the bytes of its answer.
function askBytes(question, whom = module) {
  const bytes = new TextEncoder().encode(JSON.stringify(question));
  const at = whom.question(bytes.length);
  new Uint8Array(whom.memory.buffer, at, bytes.length).set(bytes);
  const length = whom.ask();
  const answer = new Uint8Array(whom.memory.buffer, whom.answer(), length).slice();
  // Nothing else begins with this key.
  if (textOf(answer.subarray(0, 9)) === '{"error":') throw new Error(JSON.parse(textOf(answer)).error);
  return answer;
}

function textOf(bytes) { return new TextDecoder().decode(bytes); }

function ask(question, whom = module) { return JSON.parse(textOf(askBytes(question, whom))); }

async function unpack(packed) {
  const bytes = Uint8Array.from(atob(packed), letter => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const source = await new Response(stream).arrayBuffer();
  return WebAssembly.instantiate(source, { env: { clock: () => performance.now() } });
}
