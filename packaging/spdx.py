#!/usr/bin/env python3
"""What is inside a release, as SPDX 2.3 in JSON: spdx.py FOLDER VERSION COMMIT.

FOLDER has the source archive and the Debian packages. Each package is listed with its checksum, its files
and theirs, and what it depends on; and so is what is compiled into it although it is not kiln's own.
"""
import datetime
import hashlib
import io
import json
import os
import re
import subprocess
import sys
import tarfile

# Libraries of which kiln includes headers with code in them, by their package, and how they are licensed.
COMPILED_IN = {"libcglm-dev": "MIT"}


def digests(data):
    return [{"algorithm": name, "checksumValue": hashlib.new(name.lower(), data).hexdigest()}
            for name in ("SHA1", "SHA256")]


def identifier(*words):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.]+", "-", "-".join(words)).strip("-")


def field(package, name):
    return subprocess.run(["dpkg-deb", "--field", package, name], check=True, capture_output=True,
                          text=True).stdout.strip()


def files_of(package):
    """The regular files of a package: their paths and bytes, in order."""
    data = subprocess.run(["dpkg-deb", "--fsys-tarfile", package], check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        for member in sorted(archive.getmembers(), key=lambda member: member.name):
            if member.isfile():
                yield member.name, archive.extractfile(member).read()


def dependencies(package):
    """Names of packages that it depends on or recommends; of alternatives the first. Which versions will do is said
    by the package itself."""
    for kind in ("Depends", "Pre-Depends", "Recommends"):
        for clause in filter(None, field(package, kind).split(",")):
            yield clause.split("|")[0].split()[0]


def describe(package, version, commit, document):
    """Adds a package, its files and what it depends on to the document."""
    name = field(package, "Package")
    own = identifier("Package", name)
    with open(package, "rb") as file:
        checksums = digests(file.read())
    sums = []
    for path, data in files_of(package):
        file_id = identifier("File", name, path)
        document["files"].append({
            "SPDXID": file_id, "fileName": path, "checksums": digests(data),
            "licenseConcluded": "MIT", "licenseInfoInFiles": ["NOASSERTION"], "copyrightText": "NOASSERTION"})
        document["relationships"].append({
            "spdxElementId": own, "relationshipType": "CONTAINS", "relatedSpdxElement": file_id})
        sums.append(hashlib.sha1(data).hexdigest())
    document["packages"].append({
        "SPDXID": own, "name": name, "versionInfo": field(package, "Version"),
        "packageFileName": os.path.basename(package), "supplier": "Organization: the kiln authors",
        "downloadLocation": "NOASSERTION", "filesAnalyzed": True,
        "packageVerificationCode": {
            "packageVerificationCodeValue": hashlib.sha1("".join(sorted(sums)).encode()).hexdigest()},
        "checksums": checksums, "sourceInfo": f"kiln {version}, commit {commit}",
        "licenseConcluded": "MIT", "licenseDeclared": "MIT", "licenseInfoFromFiles": ["NOASSERTION"],
        "copyrightText": "2026 the kiln authors"})
    return own, list(dependencies(package))


def foreign(name, version, licence, document):
    """Adds a package of Debian once, and says how it is called."""
    own = identifier("Debian", name)
    if all(package["SPDXID"] != own for package in document["packages"]):
        package = {
            "SPDXID": own, "name": name, "supplier": "Organization: Debian", "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False, "licenseConcluded": "NOASSERTION", "licenseDeclared": licence,
            "copyrightText": "NOASSERTION",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:deb/debian/{name}"}]}
        if version:
            package["versionInfo"] = version
        document["packages"].append(package)
    return own


def main(folder, version, commit):
    created = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
    document = {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"kiln-{version}", "documentNamespace": f"https://spdx.org/spdxdocs/kiln-{version}-{commit}",
        "creationInfo": {"created": created.strftime("%Y-%m-%dT%H:%M:%SZ"),
                         "creators": [f"Tool: kiln-{version}-packaging-spdx.py"]},
        "packages": [], "files": [], "relationships": []}
    packages = sorted(name for name in os.listdir(folder) if name.endswith(".deb"))
    described = [describe(os.path.join(folder, package), version, commit, document) for package in packages]
    ours = {own for own, _ in described}
    for own, needs in described:
        document["relationships"].append({
            "spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": own})
        for name in needs:
            of_kiln = identifier("Package", name)
            other = of_kiln if of_kiln in ours else foreign(name, None, "NOASSERTION", document)
            document["relationships"].append({
                "spdxElementId": own, "relationshipType": "DEPENDS_ON", "relatedSpdxElement": other})
    for name, licence in COMPILED_IN.items():
        found = subprocess.run(["dpkg-query", "-W", "-f=${Version}", name], check=True, capture_output=True,
                               text=True).stdout
        other = foreign(name, found, licence, document)
        for package in ("kiln", "libkiln0", "libkiln-dev"):
            document["relationships"].append({
                "spdxElementId": identifier("Package", package), "relationshipType": "STATIC_LINK",
                "relatedSpdxElement": other})
    json.dump(document, sys.stdout, indent=1, sort_keys=True)
    print()


if __name__ == "__main__":
    main(*sys.argv[1:])
