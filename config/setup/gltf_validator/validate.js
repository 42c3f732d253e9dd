// node validate.js MODULES FOLDER: Khronos' validator on FOLDER/model.gltf with all it refers to. Prints the issues; exits with 1 if there is an error
// or a warning, 2 if MODULES holds no validator.
const fs = require('fs'), path = require('path');
const [modules, folder] = process.argv.slice(2);
let validator;
try {
  validator = require(path.resolve(modules, 'gltf-validator'));
} catch (error) {
  console.log(String(error));
  process.exit(2);
}
const read = (name) => new Uint8Array(fs.readFileSync(path.join(folder, name)));
const refuse = (error) => {
  console.log(String(error));
  process.exit(1);
};
try {
  validator
    .validateBytes(read('model.gltf'), { uri: 'model.gltf', externalResourceFunction: (name) => Promise.resolve().then(() => read(name)) })
    .then((report) => {
      console.log(JSON.stringify(report.issues, null, 1));
      process.exit(report.issues.numErrors + report.issues.numWarnings > 0 ? 1 : 0);
    }, refuse);
} catch (error) {
  refuse(error);
}
