// openrt_lamps.cpp: error over time of light from lamps, by path tracing through the C API, on one
// thread. relMSE is the mean of (I - R)^2 / (R^2 + 0.01) over pixels and colours at 16 samples per
// pixel, against a reference with many samples. The benchmark reports relMSE and its product with
// the CPU seconds of a frame. Lower is better. The product is independent of the number of samples
// as long as the squared error is inversely proportional to it.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <functional>
#include <vector>

#include "openrt/openrt.h"

namespace {

constexpr int size = 96, samples = 16, referenceSamples = 1024;

RTid matt(float r, float g, float b, float radiance = 0) {
  const RTid shader = rtNewShader(rtNewShaderClass("Diffuse", nullptr));
  rtBindShader(shader);
  rtParameter3f(rtParameterHandle("reflectance"), r, g, b);
  rtParameter3f(rtParameterHandle("emission"), radiance, radiance, radiance);
  return shader;
}

void quad(const float (&p)[4][3]) {
  for (const auto& v : p) rtVertex3f(v[0], v[1], v[2]);
}

RTid shape(RTid shader, RTenum primitive, const std::function<void()>& vertices) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(primitive);
  vertices();
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  return rtInstantiateObject(object);
}

void box(float x, float z, float half, float height, double turn) {
  rtPushMatrix();
  rtTranslated(x, 0, z);
  rtRotated(turn, 0, 1, 0);
  shape(matt(.7f, .7f, .7f), RT_QUADS, [&] {
    const float a = half, h = height;
    quad({{-a, h, a}, {a, h, a}, {a, h, -a}, {-a, h, -a}});
    quad({{-a, 0, a}, {a, 0, a}, {a, h, a}, {-a, h, a}});
    quad({{a, 0, -a}, {-a, 0, -a}, {-a, h, -a}, {a, h, -a}});
    quad({{a, 0, a}, {a, 0, -a}, {a, h, -a}, {a, h, a}});
    quad({{-a, 0, -a}, {-a, 0, a}, {-a, h, a}, {-a, h, -a}});
  });
  rtPopMatrix();
}

void room() {
  shape(matt(.7f, .7f, .7f), RT_QUADS, [] {
    quad({{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}});
    quad({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}});
    quad({{-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1}});
  });
  shape(matt(.63f, .06f, .05f), RT_QUADS, [] {
    quad({{-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}});
  });
  shape(matt(.14f, .45f, .09f), RT_QUADS, [] {
    quad({{1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1}});
  });
  box(-.35f, -.3f, .3f, 1.2f, 18);
  box(.35f, .35f, .3f, .6f, -17);
}

void cornell() {
  room();
  shape(matt(0, 0, 0, 15), RT_QUADS, [] {
    quad({{-.25f, 1.98f, -.25f}, {.25f, 1.98f, -.25f}, {.25f, 1.98f, .25f}, {-.25f, 1.98f, .25f}});
  });
}

// A torus of 4,000 triangles under the ceiling.
void ring() {
  room();
  shape(matt(0, 0, 0, 8), RT_TRIANGLES, [] {
    constexpr int around = 100, across = 20;
    const auto vertex = [&](int i, int j) {
      const double a = 2 * M_PI * i / around, b = 2 * M_PI * j / across, r = .5 + .03 * std::cos(b);
      rtVertex3d(r * std::cos(a), 1.8 + .03 * std::sin(b), r * std::sin(a));
    };
    for (int i = 0; i < around; i++)
      for (int j = 0; j < across; j++) {
        vertex(i, j);
        vertex(i + 1, j);
        vertex(i + 1, j + 1);
        vertex(i, j);
        vertex(i + 1, j + 1);
        vertex(i, j + 1);
      }
  });
}

// Four light tubes close to the walls.
void tubes() {
  room();
  for (const float x : {-.97f, -.3f, .3f, .97f})
    shape(matt(0, 0, 0, 10), RT_QUADS, [x] {
      quad({{x - .02f, 1.97f, -.9f},
            {x + .02f, 1.97f, -.9f},
            {x + .02f, 1.97f, .9f},
            {x - .02f, 1.97f, .9f}});
    });
}

void thousandLights() {
  room();
  for (int i = 0; i < 1000; i++) {
    const RTid light = rtNewShader(rtNewShaderClass("VRML97PointLight", nullptr));
    rtBindShader(light);
    rtParameter3f(rtParameterHandle("location"), float(i % 10) * .2f - .9f,
                  float(i / 10 % 10) * .19f + .1f, float(i / 100) * .2f - .9f);
    rtParameter3f(rtParameterHandle("attenuation"), 0, 0, 1e3f);
    rtParameter1f(rtParameterHandle("intensity"), i % 7 ? .5f : 4.f);
    rtBindShader(0);
    rtUseLight(light);
  }
}

std::vector<float> picture(int spp, int seed, double* seconds) {
  rtQuality(RT_SAMPLES_PER_PIXEL, spp);
  rtQuality(RT_SEED, seed);
  rtFrameBuffer(size, size, RT_RGBA);
  const std::clock_t begin = std::clock();
  rtRender();
  if (seconds) *seconds += double(std::clock() - begin) / CLOCKS_PER_SEC;
  std::vector<float> out(size_t(size) * size * 4);
  rtReadPixels(RT_RGBA, out.data(), out.size());
  return out;
}

void lamps(benchmark::State& state, void (*scene)(), int reference) {
  RTcontext context = rtNewContext("threads=1");
  rtLoadIdentity();
  scene();
  rtPushMatrix();
  rtLoadIdentity();
  rtLookAt(0, 1, 4.3, 0, 1, 0, 0, 1, 0);
  rtPerspective(36);
  rtPopMatrix();
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_MAX_DEPTH, 8);
  const std::vector<float> exact = picture(reference, 1000, nullptr);
  double seconds = 0, error = 0;
  int seed = 0;
  for (auto _ : state) {
    const std::vector<float> got = picture(samples, ++seed, &seconds);
    double sum = 0;
    for (size_t i = 0; i < got.size(); i++) {
      const double r = double(exact[i]), e = double(got[i]) - r;
      if (i % 4 != 3) sum += e * e / (r * r + .01);
    }
    error += sum / (double(size) * size * 3);
  }
  state.counters["relMSE"] = error / seed;
  state.counters["seconds"] = seconds / seed;
  state.counters["relMSE_x_s"] = error / seed * seconds / seed;
  rtDeleteContext(context);
}

BENCHMARK_CAPTURE(lamps, cornell, cornell, referenceSamples)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(6);
BENCHMARK_CAPTURE(lamps, ring_of_4000_triangles, ring, referenceSamples)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(6);
BENCHMARK_CAPTURE(lamps, tubes_near_walls, tubes, referenceSamples)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(6);
BENCHMARK_CAPTURE(lamps, a_thousand_lights, thousandLights, 256)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(2);

} // namespace
