// What the Khronos glTF validator says of files: `node validate.mjs FILE...` prints a line for each error and warning
// and one that counts them: `FILE: <errors> errors, <warnings> warnings`.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';

const validator = createRequire(import.meta.url)('gltf-validator');

for (const file of process.argv.slice(2)) {
  const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
    uri: file,
    maxIssues: 100,
    externalResourceFunction: async (uri) => new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri)))),
  });
  for (const { severity, code, message, pointer } of issues.messages)
    if (severity < 2) console.log(`${file}: ${severity === 0 ? 'error' : 'warning'} ${code} ${pointer ?? ''}: ${message}`);
  console.log(`${file}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
}
