# A hub's certificates and one building, in an empty folder.
before() {
  command -v openssl >/dev/null || lacks "no openssl"
  framewatch fleet help >/dev/null || lacks "framewatch-fleet is not built (deploy/install-deps --with fleet)"
}
expected='
^hub: the authority, 3 servers, operator, worker, page and admin; 0 buildings
^ca.key$
^hub3.pem$
^users.conf$
^Keep fleet.key here. Send fleet.csr to the operator of the hub.
^kobe-03: send fleet.pem back to the building, with hub/ca.pem
^Copy hub/users.conf to every server
^kobe-03 is no longer admitted
'
