// Tangents of the npm package `mikktspace`: the MikkTSpace of its author, compiled to WebAssembly.
//
//   node mikktspace.mjs make IN OUT    tangents of every mesh in IN
//   node mikktspace.mjs race IN        of the first mesh in IN, once a line of standard input; answers
//                                      `mikktspace: <processor seconds> <seconds>`, first `mikktspace: ready`
//
// IN holds meshes one after the other, little-endian: how many corners (32-bit), then for all corners floats:
// positions (3 each), normals (3), texture coordinates (2). OUT gets 4 floats a corner.
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { createInterface } from 'node:readline';

const { generateTangents } = createRequire(import.meta.url)('mikktspace');

// The package loses neighbours at the last vertex in its own order: a triangle apart from all others takes that
// place, and its tangents are dropped.
const apart = { positions: [9e6, 9e6, 9e6, 9e6 + 1, 9e6, 9e6, 9e6, 9e6 + 1, 9e6], normals: [0, 0, 1, 0, 0, 1, 0, 0, 1],
  uvs: [0, 0, 1, 0, 0, 1] };

function meshes(file) {
  const bytes = readFileSync(file);
  const all = [];
  for (let at = 0; at < bytes.length;) {
    const corners = bytes.readUInt32LE(at);
    at += 4;
    const take = (components, extra) => {
      const floats = new Float32Array(components * corners + extra.length);
      for (let i = 0; i < components * corners; ++i, at += 4) floats[i] = bytes.readFloatLE(at);
      floats.set(extra, components * corners);
      return floats;
    };
    all.push([take(3, apart.positions), take(3, apart.normals), take(2, apart.uvs)]);
  }
  return all;
}

const [, , job, input, output] = process.argv;
if (job === 'make') {
  const results = meshes(input).map((mesh) => {
    const tangents = generateTangents(...mesh);
    return Buffer.from(tangents.buffer, tangents.byteOffset, 4 * (tangents.length - 12));
  });
  writeFileSync(output, Buffer.concat(results));
} else if (job === 'race') {
  const [mesh] = meshes(input);
  console.log('mikktspace: ready');
  for await (const ignored of createInterface({ input: process.stdin })) {
    const cpu = process.cpuUsage();
    const start = process.hrtime.bigint();
    generateTangents(...mesh);
    const wall = Number(process.hrtime.bigint() - start) * 1e-9;
    const used = process.cpuUsage(cpu);
    console.log(`mikktspace: ${(used.user + used.system) * 1e-6} ${wall}`);
  }
} else {
  console.error('usage: node mikktspace.mjs make IN OUT | race IN');
  process.exit(2);
}
