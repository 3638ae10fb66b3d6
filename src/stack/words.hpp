#pragma once

/// The choices a stack document offers by name. The same words serve the command line.

#include <surfgrad/triplanar.hpp>
#include <surfgrad/worley.hpp>

#include <array>
#include <string_view>

namespace surfgrad::stack {

/// How a layer joins the sum of its pass. With w = mask * opacity:
/// add: G += w * scale * g. mix: G = (1 - w) * G + w * scale * g, in document order.
enum class Blend { add, mix };
/// What lies outside the unit square of a map.
enum class Wrap { repeat, mirror, clamp };
/// How texels are filtered. anisotropic: several trilinear probes along the longer axis of a footprint;
/// normal: trilinear, but of normals as they are encoded instead of slopes, as GPUs do.
enum class Filter { nearest, bilinear, trilinear, anisotropic, normal };
/// How a map covers more than its unit square: by repetition, or by blended, randomly shifted and turned
/// copies in hexagons that hide it.
enum class Tiling { plain, hex };
/// Which channels of a normal map hold the vector. xy reconstructs z from the unit length; automatic
/// is xy for a two-channel file or one of constant blue, else xyz.
enum class Channels { automatic, xyz, xy };
/// What the texels of a projected map are: tangent-space normals, slopes, or heights.
enum class Content { normal, derivative, height };
/// The same for a triplanar projection, whose maps may also hold whole normals.
enum class TriplanarContent { normal, derivative, height, object_normal };
/// Which code of an 8-bit derivative map means flat: 127.5, so that the codes span the range evenly and
/// none is exactly flat, or the whole code 128, as signed formats have it (32767.5 and 32768 of 16 bits).
enum class NeutralCode { between, whole };
/// Whether the green channel of a normal map points along +t (up) or against it.
enum class Green { up, down };
/// The frame a tangent-space normal map was made for: MikkTSpace at the vertices, or the frame derived
/// per fragment from the texture coordinate.
enum class Basis { mikktspace, derived };
enum class Space { object, world };
/// Whether heights displace the surface, so that a map that repeats more often is steeper, or only
/// stand for slopes, as normal maps do, whatever the size they are laid on with.
enum class HeightMode { physical, scale_free };
/// What displacements are measured in: the scene's units, or the object's, which grow with it.
enum class Units { scene, object };
/// How the slope of a height map is measured in a pixel: from one height a pixel, by differences within
/// blocks of 2x2 pixels; from three; or from three where the map is minified, and where it is magnified
/// from a smooth surface through 4x4 texels.
enum class Taps { one, three, bicubic };
/// How the point is found that parallax shows: by the height under the fragment, or where the view first
/// meets the heights.
enum class ParallaxMethod { offset, occlusion };
/// What mip levels are chosen by after a parallax: the footprint on the mesh, or that on the relief.
enum class ParallaxLod { base, displaced };
/// What the layers after a parallax perturb: the normal of its heights, or still the smooth one.
enum class ParallaxNormal { height, none };
/// What plane the footprint is measured on where the normal of a relief faces away: its own all the
/// same, or the one reflected towards the viewer.
enum class Facing { keep, reflect };
/// What a surface seen from behind shows. same: the front's normal; mirror: the interpolated normal
/// negated; flip: that, and the bumps negated too; cull: nothing.
enum class BackFaces { same, mirror, flip, cull };
enum class MaskChannel { r, g, b, a };
/// Functions of space: three noises, and three ways to sum octaves of one.
enum class NoiseKind { perlin, simplex, worley, fractal_sum, turbulence, ridged };
enum class NoiseBasis { perlin, simplex, worley };
/// surface_gradient: the gradient's part along the surface; perlin1985: the whole gradient added to the
/// normal, as Perlin did in 1985, to compare with.
enum class NoiseMethod { surface_gradient, perlin1985 };
enum class DecalShape { box, cone, sphere, capsule, wedge };
/// How a decal joins the sum of its pass: as Blend, or replace: the decal's own direction becomes the
/// normal, G = (1 - w) * G + w * g of that direction.
enum class DecalBlend { add, mix, replace };
/// What a slope in the image of a cone or wedge adds to the volume gradient: with the perspective term, or
/// without it, as in a box.
enum class ConeGradient { exact, scale_free };

/// Where a subdivision puts the vertex in the middle of an edge: halfway, or on a curve that leaves both
/// ends perpendicular to their normals.
enum class Edges { straight, curved };

template <class E>
struct Word {
  std::string_view text;
  E value;
};

/// The words of an enumeration, in the order in which messages list them. Channels::automatic has
/// none: it is what a document says by leaving the key out.
template <class E>
inline constexpr auto words_of = nullptr;

template <>
inline constexpr auto words_of<Blend> = std::to_array<Word<Blend>>({{"add", Blend::add},
                                                                    {"mix", Blend::mix}});
template <>
inline constexpr auto words_of<Wrap> =
    std::to_array<Word<Wrap>>({{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}});
template <>
inline constexpr auto words_of<Filter> = std::to_array<Word<Filter>>({{"nearest", Filter::nearest},
                                                                      {"bilinear", Filter::bilinear},
                                                                      {"trilinear", Filter::trilinear},
                                                                      {"anisotropic", Filter::anisotropic},
                                                                      {"normal", Filter::normal}});
template <>
inline constexpr auto words_of<Tiling> = std::to_array<Word<Tiling>>({{"plain", Tiling::plain},
                                                                      {"hex", Tiling::hex}});
template <>
inline constexpr auto words_of<Channels> = std::to_array<Word<Channels>>({{"xyz", Channels::xyz},
                                                                          {"xy", Channels::xy}});
template <>
inline constexpr auto words_of<Content> = std::to_array<Word<Content>>({{"normal", Content::normal},
                                                                        {"derivative", Content::derivative},
                                                                        {"height", Content::height}});
template <>
inline constexpr auto words_of<TriplanarContent> =
    std::to_array<Word<TriplanarContent>>({{"normal", TriplanarContent::normal},
                                           {"derivative", TriplanarContent::derivative},
                                           {"height", TriplanarContent::height},
                                           {"object_normal", TriplanarContent::object_normal}});
template <>
inline constexpr auto words_of<NeutralCode> =
    std::to_array<Word<NeutralCode>>({{"between", NeutralCode::between}, {"whole", NeutralCode::whole}});
template <>
inline constexpr auto words_of<Green> = std::to_array<Word<Green>>({{"up", Green::up},
                                                                    {"down", Green::down}});
template <>
inline constexpr auto words_of<Basis> = std::to_array<Word<Basis>>({{"mikktspace", Basis::mikktspace},
                                                                    {"derived", Basis::derived}});
template <>
inline constexpr auto words_of<Space> = std::to_array<Word<Space>>({{"object", Space::object},
                                                                    {"world", Space::world}});
template <>
inline constexpr auto words_of<HeightMode> = std::to_array<Word<HeightMode>>(
    {{"physical", HeightMode::physical}, {"scale_free", HeightMode::scale_free}});
template <>
inline constexpr auto words_of<Units> = std::to_array<Word<Units>>({{"scene", Units::scene},
                                                                    {"object", Units::object}});
template <>
inline constexpr auto words_of<Taps> =
    std::to_array<Word<Taps>>({{"one", Taps::one}, {"three", Taps::three}, {"bicubic", Taps::bicubic}});
template <>
inline constexpr auto words_of<ParallaxMethod> = std::to_array<Word<ParallaxMethod>>(
    {{"offset", ParallaxMethod::offset}, {"occlusion", ParallaxMethod::occlusion}});
template <>
inline constexpr auto words_of<ParallaxLod> =
    std::to_array<Word<ParallaxLod>>({{"base", ParallaxLod::base}, {"displaced", ParallaxLod::displaced}});
template <>
inline constexpr auto words_of<ParallaxNormal> =
    std::to_array<Word<ParallaxNormal>>({{"height", ParallaxNormal::height}, {"none", ParallaxNormal::none}});
template <>
inline constexpr auto words_of<Facing> = std::to_array<Word<Facing>>({{"keep", Facing::keep},
                                                                      {"reflect", Facing::reflect}});
template <>
inline constexpr auto words_of<BackFaces> = std::to_array<Word<BackFaces>>({{"same", BackFaces::same},
                                                                            {"mirror", BackFaces::mirror},
                                                                            {"flip", BackFaces::flip},
                                                                            {"cull", BackFaces::cull}});
template <>
inline constexpr auto words_of<MaskChannel> = std::to_array<Word<MaskChannel>>(
    {{"r", MaskChannel::r}, {"g", MaskChannel::g}, {"b", MaskChannel::b}, {"a", MaskChannel::a}});
template <>
inline constexpr auto words_of<Edges> = std::to_array<Word<Edges>>({{"straight", Edges::straight},
                                                                    {"curved", Edges::curved}});
template <>
inline constexpr auto
    words_of<NoiseKind> = std::to_array<Word<NoiseKind>>({{"perlin", NoiseKind::perlin},
                                                          {"simplex", NoiseKind::simplex},
                                                          {"worley", NoiseKind::worley},
                                                          {"fractal_sum", NoiseKind::fractal_sum},
                                                          {"turbulence", NoiseKind::turbulence},
                                                          {"ridged", NoiseKind::ridged}});
template <>
inline constexpr auto words_of<NoiseBasis> = std::to_array<Word<NoiseBasis>>(
    {{"perlin", NoiseBasis::perlin}, {"simplex", NoiseBasis::simplex}, {"worley", NoiseBasis::worley}});
template <>
inline constexpr auto words_of<NoiseMethod> = std::to_array<Word<NoiseMethod>>(
    {{"surface_gradient", NoiseMethod::surface_gradient}, {"perlin1985", NoiseMethod::perlin1985}});
template <>
inline constexpr auto words_of<WorleyKind> =
    std::to_array<Word<WorleyKind>>({{"f1", WorleyKind::f1}, {"f2_minus_f1", WorleyKind::f2_minus_f1}});
template <>
inline constexpr auto words_of<PlaneAxis> =
    std::to_array<Word<PlaneAxis>>({{"x", PlaneAxis::x}, {"y", PlaneAxis::y}, {"z", PlaneAxis::z}});
template <>
inline constexpr auto words_of<Handedness> = std::to_array<Word<Handedness>>({{"left", Handedness::left},
                                                                              {"right", Handedness::right}});
template <>
inline constexpr auto words_of<TextureOrigin> = std::to_array<Word<TextureOrigin>>(
    {{"lower_left", TextureOrigin::lower_left}, {"upper_left", TextureOrigin::upper_left}});
template <>
inline constexpr auto words_of<TriplanarPlanes> = std::to_array<Word<TriplanarPlanes>>(
    {{"mikkelsen", TriplanarPlanes::mikkelsen}, {"golubev", TriplanarPlanes::golubev}});
template <>
inline constexpr auto
    words_of<DecalShape> = std::to_array<Word<DecalShape>>({{"box", DecalShape::box},
                                                            {"cone", DecalShape::cone},
                                                            {"sphere", DecalShape::sphere},
                                                            {"capsule", DecalShape::capsule},
                                                            {"wedge", DecalShape::wedge}});
template <>
inline constexpr auto words_of<DecalBlend> = std::to_array<Word<DecalBlend>>(
    {{"add", DecalBlend::add}, {"mix", DecalBlend::mix}, {"replace", DecalBlend::replace}});
template <>
inline constexpr auto words_of<ConeGradient> = std::to_array<Word<ConeGradient>>(
    {{"exact", ConeGradient::exact}, {"scale_free", ConeGradient::scale_free}});

} // namespace surfgrad::stack
