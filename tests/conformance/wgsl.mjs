// WGSL for the tests.
//
//   node wgsl.mjs check FILE...                  validates with Dawn (uniformity included) and with naga
//   node wgsl.mjs spirv FILE OUT [FILE OUT]...   writes what naga makes of each as SPIR-V, functions by their names
//
// Messages go to standard error; exit status 1 where a file is refused.

import { readFileSync, writeFileSync } from "node:fs";
import { parseWgsl, validate, writeSpirv } from "naga-wasm";

function inNaga(file, use) {
  try {
    const module = parseWgsl(readFileSync(file, "utf8"));
    use(module, validate(module));
    return true;
  } catch (error) {
    console.error(`${file}: naga: ${error.formatted ?? error}`);
    return false;
  }
}

let gpu, adapter, device; // alive to the end: Dawn aborts where a device outlives the others

async function inDawn(files) {
  const { create, globals } = await import("webgpu");
  Object.assign(globalThis, globals);
  // The null backend validates and draws nothing: no driver is needed.
  gpu = create(["backend=null"]);
  adapter = await gpu.requestAdapter();
  device = await adapter.requestDevice();
  let accepted = true;
  for (const file of files) {
    device.pushErrorScope("validation");
    const module = device.createShaderModule({ code: readFileSync(file, "utf8") });
    const { messages } = await module.getCompilationInfo();
    for (const { type, lineNum, linePos, message } of messages)
      console.error(`${file}:${lineNum}:${linePos}: Dawn: ${type}: ${message}`);
    // Warnings count: the libraries compile without any.
    if ((await device.popErrorScope()) !== null || messages.length > 0) accepted = false;
  }
  return accepted;
}

const [verb, ...files] = process.argv.slice(2);
if (verb === "check" && files.length > 0) {
  const accepted = files.map((file) => inNaga(file, () => {}));
  accepted.push(await inDawn(files));
  process.exitCode = accepted.every((a) => a) ? 0 : 1;
} else if (verb === "spirv" && files.length > 0 && files.length % 2 === 0) {
  process.exitCode = 0;
  for (let i = 0; i < files.length; i += 2) {
    const written = inNaga(files[i], (module, info) => {
      const flags = { adjustCoordinateSpace: false, debug: true };
      const { buffer, byteOffset, byteLength } = writeSpirv(module, info, { flags });
      writeFileSync(files[i + 1], new Uint8Array(buffer, byteOffset, byteLength));
    });
    if (!written) process.exitCode = 1;
  }
} else {
  console.error("usage: node wgsl.mjs check FILE... | node wgsl.mjs spirv FILE OUT [FILE OUT]...");
  process.exitCode = 2;
}
