// Remembers what each stream is asked for, as it leaves the page.
() => {
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (data) {
    const said = JSON.parse(data);
    if (said.room) window.lastStream = said;
    return send.call(this, data);
  };
}
