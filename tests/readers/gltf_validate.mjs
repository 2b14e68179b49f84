// node gltf_validate.mjs FILE...: Khronos' gltf-validator finds neither errors nor warnings.
import {readFileSync} from 'node:fs';
import validator from 'gltf-validator';

let failed = false;
for (const path of process.argv.slice(2)) {
  const {issues} = await validator.validateBytes(new Uint8Array(readFileSync(path)));
  console.log(`${path}: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
  for (const issue of issues.messages.filter((each) => each.severity < 2).slice(0, 10)) {
    console.log(`  ${issue.code} ${issue.pointer ?? ''} ${issue.message}`);
    failed = true;
  }
}
process.exit(failed ? 1 : 0);
