// node validate.js MODULES FOLDER: MaterialX's own library, as built for browsers, on FOLDER/model.mtlx with its standard libraries. Says what is
// wrong, or what it found; exits with 1 if anything is wrong, 2 if MODULES holds no library.
// Of the package only bin/ is used, which is MaterialX itself (Apache-2.0); for its own code for browsers the package states no licence.
const fs = require('fs'), path = require('path'), url = require('url');
const [modules, folder] = process.argv.slice(2);
const WORKING_SPACE = 'lin_rec709';  // what the library turns colours into
const faults = [];
process.exitCode = 2;  // of a library that lacks one of its files nothing is heard

async function library() {
  const bin = path.resolve(modules, '@needle-tools/materialx/bin');
  // It has a branch for node, but is an ES module, which lacks the two names that this branch uses.
  globalThis.require = require;
  globalThis.__dirname = bin;
  const { default: load } = await import(url.pathToFileURL(path.join(bin, 'JsMaterialXGenShader.js')).href);
  const complain = (line) => faults.push(`the library says: ${line}`);  // it prints only what it cannot do, such as a colour space it does not know
  return load({ locateFile: (name) => path.join(bin, name.endsWith('.data') ? name + '.txt' : name), print: complain, printErr: complain });
}

const all = (element) => [element, ...element.getChildren().flatMap(all)];
const nodes = (document) => [document, ...document.getNodeGraphs()].flatMap((graph) => graph.getNodes());
const textures = (document) =>
  all(document).filter((element) => element.isAInput() && element.getType() === 'filename').map((input) => input.getResolvedValueString());

function check_validity(document) {
  const said = {};
  if (!document.validate(said)) faults.push(said.message.trim());
}

// validate() lets a node of a kind that nobody defines pass.
function check_nodes(document, target) {
  for (const node of nodes(document)) {
    const definition = node.getNodeDef();
    if (!definition) faults.push(`nothing defines node ${node.getName()}, a ${node.getCategory()}`);
    else if (!definition.getImplementation(target)) faults.push(`nothing implements node ${node.getName()}, a ${node.getCategory()}, for ${target}`);
  }
}

function check_textures(document) {
  for (const name of textures(document)) {
    if (path.isAbsolute(name) || !fs.existsSync(path.join(folder, name))) faults.push(`there is no texture ${name} beside the document`);
  }
}

// Pictures of colour are coded, pictures of numbers are not: a wrong word here, and nothing fails but the colours.
function check_coding(document) {
  for (const input of all(document).filter((element) => element.isAInput() && element.getType() === 'filename')) {
    const expected = input.getParent().getType() === 'color3' ? 'srgb_texture' : '';
    if (input.getColorSpace() !== expected) faults.push(`${input.getValueString()} is said to be coded as '${input.getColorSpace()}', not '${expected}'`);
  }
}

function check_colour_spaces(document, standard) {
  const known = (space) => space === WORKING_SPACE || standard.getNodeDef(`ND_${space}_to_${WORKING_SPACE}_color3`);
  for (const element of all(document)) {
    if (element.hasColorSpace() && !known(element.getColorSpace())) faults.push(`nothing defines colour space ${element.getColorSpace()}`);
  }
}

function material_of(mx, document) {
  const materials = document.getNodes().filter((node) => node.getCategory() === mx.SURFACE_MATERIAL_NODE_STRING);
  const shaders = materials.flatMap((material) => mx.getShaderNodes(material));
  if (shaders.length !== 1 || shaders[0].getCategory() !== 'gltf_pbr') {
    faults.push(`${materials.length} surface materials with ${shaders.length} shaders, not one with a gltf_pbr`);
  }
  return materials[0];
}

// The textures that a stage of a shader samples for the material; the light's own have no name.
function sampled(stage) {
  const ports = Object.values(stage.getUniformBlocks()).flatMap((block) => Array.from({ length: block.size() }, (_, i) => block.get(i)));
  const files = ports.filter((port) => port.getType().getName() === 'filename' && port.getValue());
  return files.map((port) => port.getValue().getValueString()).filter((name) => name);
}

function shader_of(document, material, generator, context) {
  const shader = generator.generate('model', material, context);
  const seen = sampled(shader.getStage('pixel'));
  for (const name of textures(document)) {
    if (!seen.includes(name)) faults.push(`the shader does not sample ${name}`);
  }
  return `${shader.getSourceCode('pixel').split('\n').length} lines of ${generator.getTarget()} that sample ${seen.join(', ')}`;
}

async function check(mx) {
  const generator = mx.EsslShaderGenerator.create();
  const context = new mx.GenContext(generator);
  const standard = mx.loadStandardLibraries(context);
  const document = mx.createDocument();
  document.setDataLibrary(standard);
  await mx.readFromXmlString(document, fs.readFileSync(path.join(folder, 'model.mtlx'), 'utf8'));
  check_validity(document);
  check_nodes(document, generator.getTarget());
  check_textures(document);
  check_coding(document);
  check_colour_spaces(document, standard);
  const material = material_of(mx, document);
  if (faults.length === 0) {  // of a document that is not valid the generator may not return
    const shader = shader_of(document, material, generator, context);
    if (faults.length === 0) console.log(`MaterialX ${mx.getVersionString()}: material ${material.getName()} becomes ${shader}`);
  }
}

function end(error) {
  if (error) faults.push(String(error));
  for (const fault of faults) console.log(fault);
  process.exit(faults.length > 0 ? 1 : 0);
}

library().then(
  (mx) => check(mx).then(() => end(), (error) => end(typeof error === 'number' ? mx.getExceptionMessage(error) : error)),  // it throws C++'s as numbers
  (error) => {
    console.log(String(error));
    process.exit(2);
  });
