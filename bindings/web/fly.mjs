// Flies scenarios with the module of the page, in Node: node fly.mjs MODULE SCENARIO..., where a scenario is JSON with
// the keys of a scenario file; flights in space need a module with the feature `space`. Prints the hash of each flight's log.
import { readFile } from "node:fs/promises";

const [file, ...scenarios] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(await readFile(file), { env: { clock: () => performance.now() } });
const module = instance.exports;

function ask(question) {
  const bytes = new TextEncoder().encode(JSON.stringify(question));
  const at = module.question(bytes.length);
  new Uint8Array(module.memory.buffer, at, bytes.length).set(bytes);
  const length = module.ask();
  const answer = JSON.parse(new TextDecoder().decode(new Uint8Array(module.memory.buffer, module.answer(), length)));
  if (answer.error) throw new Error(answer.error);
  return answer;
}

for (const scenario of scenarios) {
  ask({ ask: "begin", scenario: JSON.parse(scenario) });
  while (!ask({ ask: "fly", ticks: 6000 }).ended);
  console.log(ask({ ask: "log" }).hash);
}
