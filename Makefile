# The front door. `make demo` and `make test` need nothing but Debian 12 with make: the packages come by themselves.
# Everything is built by CMake (presets: release, dev, asan-ubsan, tsan, fuzz, coverage) into build/<preset>.
JOBS ?= $(shell nproc)
PREFIX ?= /usr/local
PYTHON ?= $(firstword $(wildcard /usr/bin/python3) python3)
CLANG ?= 14
FUZZ_SECONDS ?= 60
AUDIT_SEEDS ?= 200
CORPUS ?= $(or $(OPENRT_CORPUS),../shared/corpus)
CONFIGURE = cmake --log-level=NOTICE -DPython_EXECUTABLE=$(PYTHON) -DPython3_EXECUTABLE=$(PYTHON) --preset
R = build/release
PYTEST = PYTHONPATH=$(CURDIR)/$(R)/python $(PYTHON) -m pytest -q -p no:cacheprovider
SOURCES = $(shell git ls-files '*.cpp' '*.h' '*.hpp' '*.c')
export CTEST_OUTPUT_ON_FAILURE = 1

.PHONY: docs build demo test install bench bench-live bench-render bench-transports audit accuracy corpus corpus-x3d round-trip fuzz test-alloc-failures test-write-failures cluster-campaign soak asan tsan coverage format format-check tidy packages python-sequences bench-rays test-rays test-gltf bench-isa bench-parts clean help wheel deb container test-embree4 test-debian-12 test-often campaign fuzz-targets test-wheel cross-aarch64 cross-wheel-aarch64 test-wheel-aarch64 bench-board bench-fast-view

help:
	@sed -n 's/^## //p' Makefile

## make demo          install the packages, build, and render examples/scenes/still_life.wrl to demo.png
demo: packages
	@$(CONFIGURE) release
	@cmake --build $(R) -j $(JOBS) --target vv shaders scripts
	$(R)/bin/vv examples/scenes/still_life.wrl -o demo.png --size 960x640 --spp 64
	@echo "demo.png: examples/scenes/still_life.wrl, ray traced"

## make test          install the packages, build everything, run all tests
test: packages build
	@status=0; \
	ctest --test-dir $(R) --no-tests=error -j $(JOBS) -E '^python$$' -LE timed || status=1; \
	ctest --test-dir $(R) --no-tests=error -j $(JOBS) -L timed --repeat until-pass:3 || status=1; \
	$(PYTEST) -m "not timed" tests/python || status=1; \
	for try in 1 2 3; do $(PYTEST) -m timed tests/python && break; done || status=1; \
	exit $$status

## make build         libraries, programs and tests into build/release (bin/, lib/, python/)
build:
	@$(CONFIGURE) release
	@cmake --build $(R) -j $(JOBS)

## make install       into PREFIX (default /usr/local), DESTDIR is honoured; builds no tests and no benchmarks
install:
	@$(CONFIGURE) release -DOPENRT_TESTS=OFF -DOPENRT_BENCH=OFF
	@cmake --build $(R) -j $(JOBS)
	@cmake --install $(R) --prefix $(PREFIX)

## make docs          the documentation as a site: build/docs/index.html
docs: build
	@tools/install-packages.sh docs
	@$(PYTHON) tools/docs/make_docs.py . $(R) build/docs
	@echo "build/docs/index.html"

## make wheel         the Python distribution with all that it needs, build/dist/*.whl (what `pip install .` builds)
wheel: packages
	@PYTHON=$(PYTHON) tools/make-wheel.sh build/dist $(JOBS)

## make test-wheel    installs the wheel into a bare Debian below build/ and draws with it (needs root and debootstrap)
test-wheel:
	@tools/test-wheel.sh $(firstword $(wildcard build/dist/xvrml-*.whl) build/dist/xvrml.whl) build/wheel-test

## make deb           Debian packages, build/deb/*.deb
deb: packages
	@PYTHON=$(PYTHON) tools/make-deb.sh build/deb $(JOBS)

## make container     the image `openrt`, by podman, buildah or docker (contrib/container); CONTAINER=... options for its build
container:
	@tools/make-container.sh $(CONTAINER)

## make test-embree4  build and all tests against Embree 4, in a Debian 13 of its own below build/ (needs root and debootstrap)
test-embree4:
	@tools/test-in-debian.sh trixie build/trixie $(JOBS)

## make test-debian-12  `make test` on a bare Debian 12 of its own below build/, without a compiler cache (needs root and debootstrap)
test-debian-12:
	@tools/test-in-debian.sh bookworm build/bookworm $(JOBS)

## make test-often    what has threads, windows, processes or sockets, TIMES (default 20) times: no run may fail
test-often: build
	@PYTHON=$(PYTHON) tools/test-often.sh $(R) $(or $(TIMES),20)

## make campaign      all long tests one after the other (hours), results into docs/campaigns.md; goes on where it stopped;
##                   CAMPAIGN="--list", "--only asan tsan", "--hours 2"
campaign:
	@$(PYTHON) tools/campaign.py --jobs $(JOBS) $(CAMPAIGN)

## make cross-aarch64 for 64-bit ARM on this machine, into build/aarch64 (needs root, mmdebstrap, g++-aarch64-linux-gnu); with
##                   qemu-user-static it draws a picture there
cross-aarch64: packages
	@PYTHON=$(PYTHON) tools/cross-aarch64.sh build/aarch64 $(JOBS)

## make cross-wheel-aarch64  the Python distribution for 64-bit ARM, build/aarch64/xvrml-*_aarch64.whl (needs the same)
cross-wheel-aarch64: packages
	@PYTHON=$(PYTHON) tools/cross-wheel-aarch64.sh build/aarch64 $(JOBS)

## make test-wheel-aarch64   installs that into a bare Debian for 64-bit ARM and draws with it by qemu (needs root, debootstrap)
test-wheel-aarch64:
	@tools/test-wheel.sh $(firstword $(wildcard build/aarch64/xvrml-*.whl) build/aarch64/xvrml.whl) build/aarch64/wheel-test

## make bench         benchmarks, JSON into build/bench; bench_live prints what the window does
bench: build
	@mkdir -p build/bench
	@for b in $(R)/bin/bench_*; do [ -x $$b ] || continue; \
	  $$b --benchmark_out=build/bench/$$(basename $$b).json --benchmark_out_format=json || exit 1; done

## make bench-live    live pictures of six worlds beside the true ones (FLIP), frames a second, latency and stalls into
##                   build/bench/live; STEPS=60 without the clock, for a busy machine; DOCS=1 also into docs/, WORLDS=a,b,FILE.wrl,
##                   FULL=1 better true pictures
bench-live:
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS) --target bench_live shaders scripts
	@$(PYTHON) tests/bench/live_flip.py --bench $(R)/bin/bench_live --out build/bench/live $(if $(STEPS),--steps $(STEPS)) \
	  $(if $(WORLDS),--worlds $(WORLDS)) $(if $(FULL),--pairs 6 --reference-spp 512) $(if $(DOCS),--docs)

## make bench-render  error over CPU time of the transports on twelve worlds (CSV, curves) into build/bench/render; FULL=1 for
##                   long runs, DOCS=1 also into docs/benchmarks.md, WORLDS=a,b,FILE.wrl, MITSUBA_PYTHON=... a Python that has
##                   Mitsuba 3; BINARIES="OLD NEW" compares two builds of vv in turns and builds nothing
bench-render:
ifndef BINARIES
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS) --target vv shaders openrt-replay
endif
	@$(PYTHON) tools/bench_render.py --out build/bench/render $(if $(FULL),--full) $(if $(DOCS),--docs) \
	  $(if $(WORLDS),--worlds $(WORLDS)) $(if $(BINARIES),--binaries $(BINARIES))

## make bench-transports  error over CPU time of path, light and auto on eight worlds (CSV, curves) into build/bench/transports;
##                   FULL=1 for larger pictures, which needs an idle machine (6 to 8 minutes); DOCS=1 and WORLDS as for bench-render
bench-transports: WORLDS ?= cornell,headlight,interior,board,caustic,caustic_even,glossy,dusk
bench-transports:
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS) --target vv shaders
	@$(PYTHON) tools/bench_render.py --out build/bench/transports --transports light,path,auto \
	  --worlds $(WORLDS) --seeds 2 \
	  $(if $(FULL),--size 160x120 --reference 40 --picture 2,--size 64x48 --reference 8 --picture .5) \
	  $(if $(DOCS),--docs)

## make audit         do the error bars hold? coverage over AUDIT_SEEDS (default 200) pictures of each scene, with 64 and 512 samples
audit:
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS) --target audit
	@$(R)/bin/audit $(AUDIT_SEEDS)

## make accuracy      tables of docs/accuracy.md: the numeric tests and the audit
accuracy:
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS) --target audit numeric
	@$(PYTHON) tools/accuracy.py $(R)/bin

## make corpus        table and contact sheets of a folder of VRML files (CORPUS=...) into build/corpus
corpus: build
	@$(PYTHON) tests/corpus/corpus.py --vv $(R)/bin/vv --corpus $(CORPUS) --out build/corpus

## make corpus-x3d    table of a folder of X3D, VRML 1.0 and glTF files (CORPUS_X3D=...) into build/corpus-x3d; SHEETS=1 pictures, BESIDE="FOLDER ..." differences to other browsers' pictures
corpus-x3d:
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS) --target vv shaders scripts
	@$(PYTHON) tests/corpus/corpus_x3d.py --vv $(R)/bin/vv $(if $(CORPUS_X3D),--corpus $(CORPUS_X3D)) --jobs $(JOBS) $(if $(SHEETS),--sheets) $(if $(BESIDE),--beside $(BESIDE))

## make round-trip    writes each file of that folder in every encoding, and compares the pictures, into build/round-trip (RESUME=1 goes on where it was interrupted)
round-trip:
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS) --target xvrml_python shaders scripts
	@PYTHONPATH=$(CURDIR)/$(R)/python $(PYTHON) tests/corpus/round_trip.py $(if $(CORPUS_X3D),--corpus $(CORPUS_X3D)) --jobs $(JOBS) $(if $(RESUME),--resume)

## make fuzz          every fuzz target for FUZZ_SECONDS (default 60) each
fuzz: fuzz-targets
	@tools/run-fuzz.sh build/fuzz/bin $(FUZZ_SECONDS)

fuzz-targets:
	@tools/install-packages.sh dev
	@$(CONFIGURE) fuzz && cmake --build build/fuzz -j $(JOBS)

## make asan          all tests under the sanitizers for addresses and undefined behaviour
asan: packages
	@$(CONFIGURE) asan-ubsan && cmake --build build/asan-ubsan -j $(JOBS) && ctest --preset asan-ubsan -j $(JOBS)
## make tsan          tests under the thread sanitizer; reports about programs are in build/tsan/races (TESTS="test_control ...")
tsan: packages
	@$(CONFIGURE) tsan && cmake --build build/tsan -j $(JOBS) && PYTHON=$(PYTHON) tools/run-tsan.sh build/tsan $(JOBS)

## make test-alloc-failures   load and draw a world once for each allocation, with this one failing
test-alloc-failures:
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS) --target alloc_failures
	@$(R)/bin/alloc_failures

## make test-write-failures   every kind of output once for each write, with this one failing as on a full disk
test-write-failures:
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS) --target write_failures
	@$(PYTHON) tests/failures/write_failures.py $(R)/bin $(R)/tests/failures/write_failures.so --python $(R)/python

## make cluster-campaign  workers killed at random, partitions, 10,000 frames (KILLS="--kills 10 --frames 1000")
cluster-campaign: build
	@OPENRT_BUILD=$(CURDIR)/$(R) $(PYTHON) tests/cluster/campaign.py $(KILLS)

## make soak          60 minutes (SOAK="--minutes N") of a window under Xvfb and of a cluster whose workers come and go
soak: build
	@OPENRT_BUILD=$(CURDIR)/$(R) $(PYTHON) tests/soak/soak.py $(SOAK)

## make coverage      line coverage of the tests, summary into build/coverage/coverage.txt
coverage: packages
	@$(CONFIGURE) coverage && cmake --build build/coverage -j $(JOBS) && ctest --preset coverage -j $(JOBS)
	@tools/coverage.sh build/coverage

## make format, tidy  clang-format in place; clang-tidy on the release build's commands
format:
	@tools/install-packages.sh dev
	@clang-format-$(CLANG) -i $(SOURCES)
format-check:
	@clang-format-$(CLANG) --dry-run --Werror $(SOURCES)
tidy:
	@tools/install-packages.sh dev
	@$(CONFIGURE) release && cmake --build $(R) -j $(JOBS)
	@tools/run-tidy.sh $(R) $(JOBS)

## make python-sequences   100,000 random sequences of calls of the Python package (XVRML_SEQUENCES=...)
python-sequences: build
	XVRML_SEQUENCES=$(or $(XVRML_SEQUENCES),100000) PYTHONPATH=$(CURDIR)/$(R)/python $(PYTHON) -X faulthandler -m pytest -q -p no:cacheprovider \
	  tests/python/test_random_sdk.py

## make bench-parts   worlds of many small parts: seconds of each stage and bytes a part; PARTS="100000 1000000"
PARTS ?= 100000
bench-parts: build
	@$(PYTHON) tools/bench_parts.py --vv $(R)/bin/vv --parts $(PARTS)

## make bench-board   seconds of one picture of a KiCad board, and FLIP to its picture of 1,024 samples, into build/bench/board;
##                   needs flip-evaluator on PYTHONPATH and an idle machine. Then the same for a board of 200 parts in the manner
##                   of KiCad 10; PARTS=FOLDER takes the models of kicad-packages3d
bench-board: build
	@$(PYTHON) tools/bench_board.py --vv $(R)/bin/vv --out build/bench/board
	@$(PYTHON) tools/make_kicad_board.py build/bench/board-200 $(if $(PARTS),--parts $(PARTS))
	@$(PYTHON) tools/bench_board.py --vv $(R)/bin/vv --out build/bench/board-200 --board build/bench/board-200/board.wrl

## make bench-fast-view  seconds to the first picture of a world, by the z-buffer and by rays
bench-fast-view: build
	PYTHONPATH=$(CURDIR)/$(R)/python $(PYTHON) tools/bench_fast_view.py

## make bench-rays     ray queries from numpy beside raw Embree, Open3D and embreex
bench-rays: build
	PYTHONPATH=$(CURDIR)/$(R)/python $(PYTHON) tools/bench_rays.py --raw $(R)/lib/libraw_rays.so

## make test-rays      10 million rays at vertices and edges of closed meshes: none may leave, every crossing must count once;
##                   a million in double precision, of which 4,000 are compared with exact rational arithmetic
test-rays: build
	PYTHONPATH=$(CURDIR)/$(R)/python $(PYTHON) tools/check_rays.py
	PYTHONPATH=$(CURDIR)/$(R)/python $(PYTHON) tools/check_rays.py --precision double --rays 1000000 --exact 50

## make test-gltf   ten glTF models beside a path tracer with the BRDF of the specification, strips into build/gltf
test-gltf: build
	PYTHONPATH=$(CURDIR)/$(R)/python $(PYTHON) tools/compare_gltf.py

## make bench-isa      how much pictures differ between the instruction sets of Embree's kernels (a table of docs/accuracy.md)
bench-isa: build
	PYTHONPATH=$(CURDIR)/$(R)/python $(PYTHON) tests/bench/instruction_sets.py

packages:
	@tools/install-packages.sh

## make clean         remove build/
clean:
	@rm -rf build
