// Khronos validator on the GLB files named: one JSON line a file.
const fs = require("fs");
const validator = require("gltf-validator");
(async () => {
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { uri: file });
    console.log(JSON.stringify(report.issues));
  }
})();
