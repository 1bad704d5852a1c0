// Runs avr8js for stepgen: reads one JSON request per line from stdin, answers each with one
// line of JSON. Arguments: the folder of avr8js.
"use strict";

const fs = require("fs");
const { Machine } = require("./machine.js");

let machine;
const requests = {
  open: (job) => { machine = new Machine(job); return {}; },
  run: (request) => machine.run(request),
  fine: (request) => machine.setFine(request),
  read: (request) => machine.read(request),
  write: (request) => machine.write(request),
  register: (request) => machine.register(request),
  drive: (request) => machine.drive(request),
  send: (request) => machine.send(request),
  events: () => machine.events(),
  clear: () => { machine.rows = []; return {}; },
};

function answer(line) {
  const request = JSON.parse(line);
  const reply = Buffer.from(JSON.stringify(requests[request.do](request)) + "\n");
  for (let sent = 0; sent < reply.length; ) sent += fs.writeSync(1, reply, sent);
}

const chunk = Buffer.alloc(1 << 16);
let text = "";
for (let size; (size = fs.readSync(0, chunk, 0, chunk.length, null)) > 0; ) {
  text += chunk.toString("latin1", 0, size);
  for (let end; (end = text.indexOf("\n")) >= 0; text = text.slice(end + 1)) {
    answer(text.slice(0, end));
  }
}
