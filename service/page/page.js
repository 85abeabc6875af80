var Et,lm,tf,hr,Qh,Jl,cm,Zl,um,nf,ef,Ox,ka=Symbol.for("pv"),jl={},Ql=[],Fx=/^m(i|n|o|s|text|space)$/,sf=Array.isArray,rf=Ql.slice,zr=Object.assign;function kr(n){n&&n.parentNode&&n.remove()}function hm(n,e,t){var i,s,r,o={},a=arguments.length;for(r in e)r=="key"?i=e[r]:r=="ref"&&typeof n!="function"?s=e[r]:o[r]=e[r];return a>2&&(o.children=a>3?rf.call(arguments,2):t),Ba(n,o,i,s,null)}function Ba(n,e,t,i,s){var r={type:n,props:e,key:t,ref:i,__k:null,__:null,__b:0,__e:null,__c:null,constructor:ka,__v:s||++lm,__i:-1,__u:0};return!s&&Et.vnode&&Et.vnode(r),r}function Ct(n){return n.children}function Po(n,e){this.props=n,this.context=e,this.__g=0}function fr(n,e){if(e==null)return n.__&&fr(n.__,n.__i+1);for(var t;e<n.__k.length;e++)if((t=n.__k[e])&&t.__e)return t.__e;return typeof n.type!="function"||n.props.__P?null:fr(n)}function Bx(n){var e,t=n.__v,i=t.__e,s=[],r=[],o=n.__P;o&&((e=zr({constructor:ka},t)).__v=t.__v+1,Et.vnode&&Et.vnode(e),of(o,e,t,n.__n,o.namespaceURI,32&t.__u?[i]:null,s,i||fr(t),32&t.__u,r),e.__v=t.__v,e.__.__k[e.__i]=e,_m(s,e,r),t.__=t.__e=null,e.__e!=i&&fm(e))}function fm(n){if((n=n.__)&&n.__c&&!n.props.__P)return n.__e=null,n.__k.some(function(e){return e&&(n.__e=e.__e)}),fm(n)}function om(n){(8&n.__g||(n.__g|=8,hr.push(n),Jl++))&&Qh==Et.debounceRendering||((Qh=Et.debounceRendering)||queueMicrotask)(dm)}function dm(){try{for(var n,e=1;hr.length;)hr.length>e&&hr.sort(cm),n=hr.shift(),e=hr.length,8&n.__g&&Bx(n)}finally{(Jl=hr.length)&&(Qh||queueMicrotask)(dm)}}function pm(n,e,t,i,s,r,o,a,l,c,u){var h,f,d,g,y,p,m=i.__k||Ql,x=e.length;for(l=kx(t,e,m,l,x),h=0;h<x;h++)(d=t.__k[h])!=null&&(f=~d.__i&&m[d.__i]||jl,d.__i=h,p=of(n,d,f,s,r,o,a,l,c,u),g=d.__e,(f.ref!=d.ref||8&f.__u)&&(f.ref&&af(f.ref,null,d,f),d.ref&&u.push(d.ref,d.__c||g,d)),y=y||g,4&d.__u?(l=mm(d,l,n,!f.__v),f.__e&&(f.__e=null)):typeof d.type=="function"&&p!==void 0?l=p:g&&(l=g.nextSibling),d.__u&=-21);return t.__e=y,l}function kx(n,e,t,i,s){var r,o,a,l,c,u,h,f,d,g=t.length,y=g,p=0,m=0,x=n.__k=Array(s);for(r=0;r<s;r++)(o=e[r])!=null&&typeof o!="boolean"&&typeof o!="function"?(typeof o!="object"||o.constructor===String?o=x[r]=Ba(null,o):sf(o)?o=x[r]=Ba(Ct,{children:o}):o.constructor===ka&&o.__b?o=x[r]=Ba(o.type,o.props,o.key,o.ref,o.__v):x[r]=o,l=r+p,o.__=n,o.__b=n.__b+1,a=null,~(c=o.__i=zx(o,t,l,y))&&(y--,(a=t[c])&&(a.__u|=2)),a&&a.__v?(o.__u|=16,c==l-1?p--:c==l+1?p++:c!=l&&(c>l?p--:p++,m=1)):(~c||(s>g?p--:s<g&&p++),typeof o.type!="function"&&(o.__u|=4))):x[r]=null;if(m){for(u=[],h=[],r=0;r<s;r++)if((o=x[r])&&16&o.__u){for(p=0,f=u.length;p<f;)u[d=p+f>>1]<o.__i?p=d+1:f=d;u[p]=o.__i,h[r]=p+1}for(p=u.length;r--;)h[r]&&(h[r]==p?p--:x[r].__u|=4)}if(y)for(r=0;r<g;r++)!(a=t[r])||2&a.__u||(a.__e==i&&(i=fr(a)),lf(a,a));return i}function mm(n,e,t,i){var s,r,o,a;if(typeof n.type=="function"){if(n.props.__P)return e;if(s=n.__k)for(r=0;r<s.length;r++)s[r]&&(s[r].__=n,e=mm(s[r],e,t,!1));return e}for(e&&!e.parentNode&&(e=fr(n))&&!e.parentNode&&(e=null),o=n.__e,a=e;a&&a.nodeType==8;)a=a.nextSibling;for(o!=a&&(!i&&t.moveBefore&&o.parentNode?t.moveBefore(o,e):t.insertBefore(o,e||null)),e=o;(e=e&&e.nextSibling)&&e.nodeType==8&&!e.data.startsWith("$s"););return e}function zx(n,e,t,i){var s,r=n.key,o=n.type,a=e[t],l=a&&!(2&a.__u);if(a===null&&r==null||l&&r==a.key&&o==a.type)return t;if(i>(l?1:0)){for(s=t-1;s>=0;s--)if((a=e[s])&&!(2&a.__u)&&r==a.key&&o==a.type)return s;for(s=t+1;s<e.length;s++)if((a=e[s])&&!(2&a.__u)&&r==a.key&&o==a.type)return s}return-1}function am(n,e,t){t==null&&(t=""),e[0]=="-"?n.setProperty(e,t):n[e]=t}function $l(n,e,t,i,s){var r,o;if(e=="style")if(typeof t=="string")n.style.cssText=t;else{if(typeof i=="string"&&(n.style.cssText=i=""),i)for(e in i)t&&e in t||am(n.style,e);if(t)for(e in t)i&&t[e]==i[e]||am(n.style,e,t[e])}else if(e[0]=="o"&&e[1]=="n")typeof t!="function"&&(t=null),typeof i!="function"&&(i=null),(n.__e||(n.__e={}))[e]=t,t&&i||(o=ef[e]||(ef[e]=Vx(e)),(n.__a||(n.__a={}))[e]=nf,r=e!=(e=e.replace(um,"$1")),(e=e.slice(2))[0]<"a"&&(e=e.toLowerCase()),t?n.addEventListener(e,o,r):n.removeEventListener(e,o,r));else{if(s=="http://www.w3.org/2000/svg")e=e.replace(/xlink(H|:h)/,"h").replace(/sName$/,"s");else if(e!="width"&&e!="height"&&e!="href"&&e!="list"&&e!="form"&&e!="tabIndex"&&e!="download"&&e!="rowSpan"&&e!="colSpan"&&e!="role"&&e!="popover"&&e in n)try{return void(n[e]=t??"")}catch{}if(typeof t=="function")return;t==null||t===!1&&e[4]!="-"?n.removeAttribute(e):n.setAttribute(e,e=="popover"&&t==1?"":t)}}function Vx(n){return function(e){var t=this.__e;if(t){if(t=t[n],e[Zl]==null)e[Zl]=nf++;else if(e[Zl]<this.__a[n])return;return t(Et.event?Et.event(e):e)}}}function of(n,e,t,i,s,r,o,a,l,c){var u,h,f,d,g,y,p,m,x,R,S,C,E,v,T,z,N,D,W=e.type;if(e.constructor!==ka)return null;128&t.__u&&(l=32&t.__u,u=t.__c.__z)&&(e.__u|=l,h=r=[],u.nodeType==8?a=Kl(u,r):r.push(u),a=r[0]||a),(u=Et.__b)&&u(e);e:if(typeof W=="function"){f=o.length;try{if(m=e.props,x=(u=W.prototype)&&u.render,R=(u=W.contextType)&&i[u.__c],S=u?R?R.props.value:u.__:i,(d=t.__c)?(e.__c=d,2&d.__g&&(d.__g|=1)):(x?e.__c=d=new W(m,S):(e.__c=d=new Po(m,S),d.constructor=W,d.render=Hx),R&&R.sub(d),d.state||(d.state={}),d.__n=i,d.__g|=8,d.__h=[],d.__k=[]),x&&(d.__s||(d.__s=d.state),W.getDerivedStateFromProps&&(d.__s==d.state&&(d.__s=zr({},d.__s)),zr(d.__s,W.getDerivedStateFromProps(m,d.__s)))),g=d.props,y=d.state,d.__v=e,t.__c){if(m!==g&&x&&!W.getDerivedStateFromProps&&d.componentWillReceiveProps&&d.componentWillReceiveProps(m,S),e.__v==t.__v&&!(8&d.__g)||!(4&d.__g)&&d.shouldComponentUpdate&&d.shouldComponentUpdate(m,d.__s,S)===!1){e.__v!=t.__v&&(d.props=m,d.state=d.__s,d.__g&=-9),e.__e=t.__e,e.__k=t.__k,e.__k.some(function(G){G&&(G.__=e)}),Ql.push.apply(d.__h,d.__k),d.__k=[],d.__h.length&&o.push(d),a=fr(t);break e}d.componentWillUpdate&&d.componentWillUpdate(m,d.__s,S),x&&d.componentDidUpdate&&d.__h.push(function(){d.componentDidUpdate(g,y,p)})}else x&&!W.getDerivedStateFromProps&&d.componentWillMount&&d.componentWillMount(),x&&d.componentDidMount&&d.__h.push(d.componentDidMount);d.context=S,d.props=m,d.__P=n,d.__g&=-5,C=Et.__r,E=x?25:0;do d.__g&=-9,C&&C(e),u=d.render(d.props,d.state=d.__s,d.context);while(8&d.__g&&++E<25);x&&(Ql.push.apply(d.__h,d.__k),d.__k=[]),d.state=d.__s,d.getChildContext&&(i=zr({},i,d.getChildContext())),x&&t.__c&&d.getSnapshotBeforeUpdate&&(p=d.getSnapshotBeforeUpdate(g,y)),v=u&&u.type===Ct&&u.key==null?u.props.children:u,m.__P&&(u=a,s=(n=m.__P).namespaceURI,l=r=null,t.props&&t.props.__P!=n&&(t.__k.some(function(G){G&&lf(G,G)}),t.__k=null),a=t.__k?fr(t,0):null),a=pm(n,sf(v)?v:[v],e,t,i,s,r,o,a,l,c),m.__P&&(e.__e=null,a=u),e.__u&=-161,h&&h.some(kr),d.__h.length&&o.push(d),1&d.__g&&(d.__g&=-4)}catch(G){if(o.length=f,e.__v=null,l||r)if(G&&G.then){if(e.__u|=128|l,r){for(~(N=r.indexOf(a||void 0))||(N=r.length);(D=r[N-1])&&D.nodeType==8;)N--;for(;N<r.length;N++)if(D=r[N])if(r[N]=null,T){if(D==z)break}else{if(D.nodeType!=8)break;D.data.startsWith("$s")&&(z=Kl(T=D))}}if(!T){for(;a&&a.nodeType==8&&a.nextSibling;)a=a.nextSibling;T=a}(u=Kl(T=e.__c.__z||(e.__c.__z=T)))?(e.__e=T,a=u):e.__e=a,a=a&&a.nextSibling}else r&&r.some(kr);else e.__e=t.__e;e.__k||(e.__k=t.__k||[]),G&&G.then||gm(e),Et.__e(G,e,t)}}else a=e.__e=Gx(t.__e,e,t,i,s,r,o,l,c,n);return(u=Et.diffed)&&u(e),a}function Kl(n,e){if(n&&n.nodeType==8&&n.data.startsWith("$s"))for(var t=1;n=n.nextSibling;){if(n.nodeType==8){if(n.data.startsWith("$s"))t++;else if(n.data.startsWith("/$s")&&!--t)return n}e&&e.push(n)}}function gm(n){n&&(n.__c&&(n.__c.__g|=4),n.__k&&n.__k.some(gm))}function _m(n,e,t){for(var i=0;i<t.length;)af(t[i++],t[i++],t[i++]);Et.__c&&Et.__c(e,n),n.some(function(s){try{n=s.__h,s.__h=[],n.some(function(r){r.call(s)})}catch(r){Et.__e(r,s.__v)}})}function Gx(n,e,t,i,s,r,o,a,l,c){var u,h,f,d,g,y,p,m,x=t.props||jl,R=e.props,S=e.type;if(S=="svg"?s="http://www.w3.org/2000/svg":S=="math"?s="http://www.w3.org/1998/Math/MathML":s||(s="http://www.w3.org/1999/xhtml"),r){for(u=0;u<r.length;u++)if((g=r[u])&&(S?g.localName==S:g.nodeType==3)){n=g,r[u]=null;break}}if(!n){if(m=c.ownerDocument||document,!S)return m.createTextNode(R);n=m.createElementNS(s,S,R.is?R:c),a&&(Et.__m&&Et.__m(e,r),a=!1),r=null}if(S){if(c=S=="template"&&n.content||n,r=S=="textarea"&&R.defaultValue!=null?null:r&&rf.call(c.childNodes),!a&&r)for(x={},u=0;u<n.attributes.length;u++)x[(g=n.attributes[u]).name]=g.value;for(u in x)g=x[u],u=="dangerouslySetInnerHTML"?f=g:u=="children"||u in R||u=="value"&&"defaultValue"in R||u=="checked"&&"defaultChecked"in R||$l(n,u,null,g,s);for(u in R)g=R[u],u=="children"?d=g:u=="dangerouslySetInnerHTML"?h=g:u=="value"?y=g:u=="checked"?p=g:a&&typeof g!="function"||x[u]===g||$l(n,u,g,x[u],s);h?(a||f&&(h.__html==f.__html||h.__html==n.innerHTML)||(n.innerHTML=h.__html),e.__k=[]):(f&&(n.textContent=""),(S=="foreignObject"||s=="http://www.w3.org/1998/Math/MathML"&&Fx.test(S))&&(s="http://www.w3.org/1999/xhtml"),pm(c,sf(d)?d:[d],e,t,i,s,r,o,r?r[0]:t.__k&&fr(t,0),a,l),r&&r.some(kr)),a&&S!="textarea"||(u="value",S=="progress"&&y==null?n.removeAttribute(u):y==null||y===n[u]&&(S!="progress"||y)||$l(n,u,y,x[u],s),u="checked",p!=null&&p!=n[u]&&$l(n,u,p,x[u],s))}else x===R||a&&n.data==R||(n.data=R);return n}function af(n,e,t,i){try{typeof n=="function"?e?e.__x=n(e)||1:i&&(i=i.__c||i.__e)&&(e=i.__x)&&(i.__x=null,typeof e=="function"?e():n(null)):n.current=e}catch(s){Et.__e(s,t)}}function lf(n,e,t){var i,s,r,o;if(Et.unmount&&Et.unmount(n),!(i=n.ref)||i.current&&i.current!=n.__e||af(i,null,e,n),i=n.__c){if(i.componentWillUnmount)try{i.componentWillUnmount()}catch(a){Et.__e(a,e)}i.__P=i.__n=null}if(i=n.__k)for(o=0;o<i.length;o++)i[o]&&lf(i[o],e,typeof n.type!="function"||t&&!n.props.__P);!t&&(i=n.__c)&&(i=i.__z)&&(s=Kl(i,r=[]))&&(i==n.__e&&r.some(kr),kr(s),kr(i)),t||kr(n.__e),n.__e=n.__c=n.__=null}function Hx(n,e,t){return this.constructor(n,t)}function vm(n,e){var t,i,s,r;Et.__&&Et.__(n,e),e.nodeType==9&&(e=e.documentElement),i=(t=n&&32&n.__u)?null:e.__k,e.__k=Ba(Ct,{children:[n]}),s=[],r=[],of(e,e.__k,i||jl,jl,e.namespaceURI,i?null:e.firstChild?rf.call(e.childNodes):null,s,i?i.__e:e.firstChild,t,r),_m(s,e.__k,r),e.__k.props.children=null}Et={__e:function(n,e,t,i){for(var s,r,o;e=e.__;)if((s=e.__c)&&!(1&s.__g)){s.__g|=4;try{if((o=(r=s.constructor)&&r.getDerivedStateFromError)&&s.setState(r.getDerivedStateFromError(n)),s.componentDidCatch&&(s.componentDidCatch(n,i||{}),o=1),o&&8&s.__g)return void(s.__g|=2)}catch(a){n=a}}throw Jl=0,n}},lm=0,tf=function(n){return n!=null&&n.constructor===ka},Po.prototype.setState=function(n,e){var t=this.__s;t&&t!=this.state||(t=this.__s=zr({},this.state)),typeof n=="function"&&(n=n(zr({},t),this.props)),n&&(zr(t,n),this.__v&&(e&&this.__k.push(e),om(this)))},Po.prototype.forceUpdate=function(n){this.__v&&(this.__g|=4,n&&this.__h.push(n),om(this))},Po.prototype.render=Ct,hr=[],Jl=0,cm=function(n,e){return n.__v.__b-e.__v.__b},Zl=Symbol(),um=/(PointerCapture)$|Capture$/i,nf=0,ef={},Ox=0;var Va,Cn,cf,xm,uf=Object.is,ec=0,Cm=[],hf=[],xn=Et,ym=xn.__b,bm=xn.__r,Sm=xn.diffed,Mm=xn.__c,wm=xn.unmount,Tm=xn.__;function df(n,e){xn.__h&&xn.__h(Cn,n,ec||e),ec=0;var t=Cn.__H||(Cn.__H={__:[],__h:[]});return n>=t.__.length&&t.__.push({}),t.__[n]}function Tt(n){return ec=1,Wx(Pm,n)}function Wx(n,e,t){var i=df(Va++,2);if(i.t=n,!i.__c&&(i.__=[t?t(e):Pm(void 0,e),function(r){var o=(i.__N||i.__)[0],a=i.t(o,r);uf(o,a)||(i.__N=[a,i.__[1]],i.__c.setState({}))}],i.__c=Cn,!Cn.__f)){Cn.__f=!0;var s=Cn.shouldComponentUpdate;Cn.shouldComponentUpdate=function(r,o,a){var l=this.__H;if(!l)return!0;var c=!1,u=this.props!=r;if(l.__.some(function(f){f.__N&&(c=!0,uf(f.__[0],f.__N[0])||(u=!0))}),s){var h=s.call(this,r,o,a);return c?h||u:h}return!c||u}}return i.__}function Kt(n,e){var t=df(Va++,3);!xn.__s&&Rm(t.__H,e)&&(t.__P=!0,t.__=n,t.u=e,Cn.__H.__h.push(t))}function Zn(n){return ec=5,tc(function(){return{current:n}},[])}function tc(n,e){var t=df(Va++,7);return Rm(t.__H,e)&&(t.__=n(),t.__H=e),t.__}function Xx(){var n;do{for(;n=hf.shift();)try{za(n)}catch(t){xn.__e(t,{__:(n=n.__P)&&n.__v})}for(;n=Cm.shift();){var e=n.__H;if(n.__P&&e)try{e.__h.some(za),e.__h.some(ff),e.__h=[]}catch(t){e.__h=[],xn.__e(t,n.__v)}}}while(hf.length)}xn.__b=function(n){Cn=null,ym&&ym(n)},xn.__=function(n,e){n&&e.__k&&e.__k.__m&&(n.__m=e.__k.__m),Tm&&Tm(n,e)},xn.__r=function(n){bm&&bm(n),Va=0;var e=(Cn=n.__c).__H;e&&(cf==Cn?Cn.__h=[]:(e.__h.some(za),e.__h.some(ff),Va=0),e.__h=[],e.__.some(function(t){t.__N&&(t.__=t.__N),t.u=t.__N=void 0})),cf=Cn},xn.diffed=function(n){Sm&&Sm(n);var e=n.__c;e&&e.__H&&(e.__H.__h.length&&Em(Cm.push(e)),e.__H.__.some(function(t){t.u&&(t.__H=t.u)})),cf=Cn=null},xn.__c=function(n,e){e.some(function(t){try{t.__h.some(za),t.__h=t.__h.filter(function(i){return!i.__||ff(i)})}catch(i){t.__h=[function(){throw i}]}}),Mm&&Mm(n,e)},xn.unmount=function(n){wm&&wm(n);var e,t,i=n.__c;i&&i.__H&&(i.__H.__.some(function(s){try{if(s.__P&&s.__c){if(t===void 0){for(t=n.__;t&&(!t.__c||!t.__c.__P);)t=t.__;t=t&&t.__c}s.__P=t,Em(hf.push(s))}else za(s)}catch(r){e=r}}),i.__H=void 0,e&&xn.__e(e,i.__v))};var Am=typeof requestAnimationFrame=="function";function qx(n){var e,t=function(){clearTimeout(i),Am&&cancelAnimationFrame(e),setTimeout(n)},i=setTimeout(t,35);Am&&(e=requestAnimationFrame(t))}function Em(n){n!=1&&xm==xn.requestAnimationFrame||((xm=xn.requestAnimationFrame)||qx)(Xx)}function za(n){var e=Cn,t=n.__c;typeof t=="function"&&(n.__c=void 0,t()),Cn=e}function ff(n){var e=Cn;n.__c=n.__(),Cn=e}function Rm(n,e){return!n||n.length!=e.length||e.some(function(t,i){return!uf(t,n[i])})}function Pm(n,e){return typeof e=="function"?e(n):e}var Yx=Symbol.for("preact-signals");function rc(){if(Fs>1)Fs--;else{var n,e=!1;for((function(){var s=ic;for(ic=void 0;s!==void 0;){var r=s.S;if(r.v===s.v)for(var o=r.t;o!==void 0;o=o.x)o.i===s.i&&(o.i=r.i);s=s.o}})();Ha!==void 0;){var t=Ha;for(Ha=void 0,nc++;t!==void 0;){var i=t.u;if(t.u=void 0,t.f&=-3,!(8&t.f)&&Lm(t))try{t.c()}catch(s){e||(n=s,e=!0)}t=i}}if(nc=0,Fs--,e)throw n}}function mf(n){if(Fs>0)return n();pf=++$x,Fs++;try{return n()}finally{rc()}}var Ga,nn=void 0;function Bs(n){var e=nn,t=Ga;nn=void 0,Ga=void 0;try{return n()}finally{nn=e,Ga=t}}var Ha=void 0,Fs=0,nc=0,$x=0,pf=0,ic=void 0,sc=0;function Im(n){if(nn!==void 0){var e=n.n;if(e===void 0||e.t!==nn)return e={i:0,S:n,p:nn.s,n:void 0,t:nn,e:void 0,x:void 0,r:e},nn.s!==void 0&&(nn.s.n=e),nn.s=e,n.n=e,32&nn.f&&n.S(e),e;if(e.i===-1)return e.i=0,e.n!==void 0&&(e.n.p=e.p,e.p!==void 0&&(e.p.n=e.n),e.p=nn.s,e.n=void 0,nn.s.n=e,nn.s=e),e}}function Rn(n,e){this.v=n,this.i=0,this.n=void 0,this.t=void 0,this.l=0,this.W=e?.watched,this.Z=e?.unwatched,this.name=e?.name}Rn.prototype.brand=Yx;Rn.prototype.h=function(){return!0};Rn.prototype.S=function(n){var e=this,t=this.t;t!==n&&n.e===void 0&&(n.x=t,this.t=n,t!==void 0?t.e=n:Bs(function(){var i;(i=e.W)==null||i.call(e)}))};Rn.prototype.U=function(n){var e=this;if(this.t!==void 0){var t=n.e,i=n.x;t!==void 0&&(t.x=i,n.e=void 0),i!==void 0&&(i.e=t,n.x=void 0),n===this.t&&(this.t=i,i===void 0&&Bs(function(){var s;(s=e.Z)==null||s.call(e)}))}};Rn.prototype.subscribe=function(n){var e=this;return Zi(function(){var t=e.value;Bs(function(){return n(t)})},{name:"sub"})};Rn.prototype.valueOf=function(){return this.value};Rn.prototype.toString=function(){return this.value+""};Rn.prototype.toJSON=function(){return this.value};Rn.prototype.peek=function(){var n=this;return Bs(function(){return n.value})};Object.defineProperty(Rn.prototype,"value",{get:function(){var n=Im(this);return n!==void 0&&(n.i=this.i),this.v},set:function(n){if(n!==this.v){if(nc>100)throw new Error("Cycle detected");(function(t){Fs!==0&&nc===0&&t.l!==pf&&(t.l=pf,ic={S:t,v:t.v,i:t.i,o:ic})})(this),this.v=n,this.i++,sc++,Fs++;try{for(var e=this.t;e!==void 0;e=e.x)e.t.N()}finally{rc()}}}});function Ze(n,e){return new Rn(n,e)}function Lm(n){for(var e=n.s;e!==void 0;e=e.n)if(e.S.i!==e.i||!e.S.h()||e.S.i!==e.i)return!0;return!1}function Dm(n){for(var e=n.s;e!==void 0;e=e.n){var t=e.S.n;if(t!==void 0&&(e.r=t),e.S.n=e,e.i=-1,e.n===void 0){n.s=e;break}}}function Nm(n){for(var e=n.s,t=void 0;e!==void 0;){var i=e.p;e.i===-1?(e.S.U(e),i!==void 0&&(i.n=e.n),e.n!==void 0&&(e.n.p=i)):t=e,e.S.n=e.r,e.r!==void 0&&(e.r=void 0),e=i}n.s=t}function Vr(n,e){Rn.call(this,void 0,e),this.x=n,this.s=void 0,this.g=sc-1,this.f=4}Vr.prototype=new Rn;Vr.prototype.h=function(){if(this.f&=-3,1&this.f)return!1;if((36&this.f)==32||(this.f&=-5,this.g===sc))return!0;if(this.g=sc,this.f|=1,this.i>0&&!Lm(this))return this.f&=-2,!0;var n=nn;try{Dm(this),nn=this;var e=this.x();(16&this.f||this.v!==e||this.i===0)&&(this.v=e,this.f&=-17,this.i++)}catch(t){this.v=t,this.f|=16,this.i++}return nn=n,Nm(this),this.f&=-2,!0};Vr.prototype.S=function(n){if(this.t===void 0){this.f|=36;for(var e=this.s;e!==void 0;e=e.n)e.S.S(e)}Rn.prototype.S.call(this,n)};Vr.prototype.U=function(n){if(this.t!==void 0&&(Rn.prototype.U.call(this,n),this.t===void 0)){this.f&=-33;for(var e=this.s;e!==void 0;e=e.n)e.S.U(e)}};Vr.prototype.N=function(){if(!(2&this.f)){this.f|=6;for(var n=this.t;n!==void 0;n=n.x)n.t.N()}};Object.defineProperty(Vr.prototype,"value",{get:function(){if(1&this.f)throw new Error("Cycle detected");var n=Im(this);if(this.h(),n!==void 0&&(n.i=this.i),16&this.f)throw this.v;return this.v}});function Fi(n,e){return new Vr(n,e)}function Um(n){var e=n.j;if(n.j=void 0,typeof e=="function"){Fs++;var t=nn;nn=void 0;try{e()}catch(i){throw n.f&=-2,n.f|=8,gf(n),i}finally{nn=t,rc()}}}function gf(n){for(var e=n.s;e!==void 0;e=e.n)e.S.U(e);n.x=void 0,n.s=void 0,Um(n)}function Zx(n){if(nn!==this)throw new Error("Out-of-order effect");Nm(this),nn=n,this.f&=-2;try{8&this.f&&gf(this)}finally{rc()}}function Io(n,e){this.x=n,this.j=void 0,this.s=void 0,this.u=void 0,this.f=32,this.name=e?.name,Ga&&Ga.push(this)}Io.prototype.c=function(){var n=this.S();try{if(8&this.f||this.x===void 0)return;var e=this.x();typeof e=="function"&&(this.j=e)}finally{n()}};Io.prototype.S=function(){if(1&this.f)throw new Error("Cycle detected");this.f|=1,this.f&=-9,Um(this),Dm(this),Fs++;var n=nn;return nn=this,Zx.bind(this,n)};Io.prototype.N=function(){2&this.f||(this.f|=2,this.u=Ha,Ha=this)};Io.prototype.d=function(){this.f|=8,1&this.f||gf(this)};Io.prototype.dispose=function(){this.d()};function Zi(n,e){var t=new Io(n,e);try{t.c()}catch(s){throw t.d(),s}var i=t.d.bind(t);return i[Symbol.dispose]=i,i}var Om,ac,oc,Kx=typeof window<"u"&&!!window.__PREACT_SIGNALS_DEVTOOLS__;var Fm=[];Zi(function(){Om=this.N})();function Lo(n,e){Et[n]=e.bind(null,Et[n]||function(){})}function Wa(n){if(oc){var e=oc;oc=void 0,e()}oc=n&&n.S()}function Bm(n){var e=this,t=n.data,i=jx(t);i.name="ReactiveDom",i.value=t;var s=tc(function(){for(var a=e,l=e.__v;l=l.__;)if(l.__c){l.__c.__$f|=4;break}var c=Fi(function(){var d=i.value.value;return d===0?0:d===!0?"":d||""}),u=Fi(function(){return!Array.isArray(c.value)&&!tf(c.value)}),h=Zi(function(){if(this.N=km,u.value){var d=c.value;a.__v&&a.__v.__e&&a.__v.__e.nodeType===3&&(a.__v.__e.data=d)}}),f=e.__$u.d;return e.__$u.d=function(){h(),f.call(this)},[u,c]},[]),r=s[0],o=s[1];return r.value?o.peek():o.value}Bm.displayName="ReactiveTextNode";Object.defineProperties(Rn.prototype,{constructor:{configurable:!0,value:hm(Ct,null).constructor},type:{configurable:!0,value:Bm},props:{configurable:!0,get:function(){var n=this;return{data:{get value(){return n.value}}}}},__b:{configurable:!0,value:1}});Lo("__b",function(n,e){if(Wa(),ac=void 0,typeof e.type=="string"){var t,i=e.props;for(var s in i)if(s!=="children"){var r=i[s];r instanceof Rn&&(t||(e.__np=t={}),t[s]=r,i[s]=r.peek())}}n(e)});Lo("__r",function(n,e){if(n(e),e.type!==Ct){Wa();var t,i=e.__c;i&&(i.__$f&=-2,(t=i.__$u)===void 0&&(i.__$u=t=(function(s,r){var o;return Zi(function(){o=this},{name:r}),o.c=s,o})((function(s){return function(){var r;Kx&&((r=this.y)==null||r.call(this)),s.__$f|=1,s.setState({})}})(i),typeof e.type=="function"?e.type.displayName||e.type.name:""))),ac=i,Wa(t)}});Lo("__e",function(n,e,t,i){Wa(),ac=void 0,n(e,t,i)});Lo("diffed",function(n,e){Wa(),ac=void 0;var t;if(typeof e.type=="string"&&(t=e.__e)){var i=e.__np,s=e.props,r=t.U;if(r)for(var o in r){var a=r[o];a===void 0||i&&o in i||(a.d(),r[o]=void 0)}if(i){r||(r={},t.U=r);for(var l in i){var c=r[l],u=i[l];c===void 0?(c=Jx(t,l,u,s),r[l]=c):c.o(u,s)}}}n(e)});function Jx(n,e,t,i){var s=e in n&&n.ownerSVGElement===void 0,r=Ze(t);return{o:function(o,a){r.value=o,i=a},d:Zi(function(){this.N=km;var o=r.value.value;i[e]!==o&&(i[e]=o,s?n[e]=o:o!=null&&(o!==!1||e[4]==="-")?n.setAttribute(e,o):n.removeAttribute(e))})}}Lo("unmount",function(n,e){if(typeof e.type=="string"){var t=e.__e;if(t){var i=t.U;if(i){t.U=void 0;for(var s in i){var r=i[s];r&&r.d()}}}var o=e.__np;if(o){var a=e.props;for(var l in o)a[l]=o[l]}e.__np=void 0}else{var c=e.__c;if(c){c.__$f|=8;var u=c.__$u;u&&(c.__$u=void 0,u.d())}}n(e)});Lo("__h",function(n,e,t,i){i<3&&(e.__$f|=2),n(e,t,i)});Po.prototype.shouldComponentUpdate=function(n,e){if(this.__R)return!0;var t=this.__$u,i=t&&t.s!==void 0;for(var s in e)return!0;if(this.__f||typeof this.u=="boolean"&&this.u===!0){var r=2&this.__$f;if(!(i||r||4&this.__$f)||1&this.__$f)return!0}else if(!(i||4&this.__$f)||3&this.__$f)return!0;for(var o in n)if(o!=="__source"&&n[o]!==this.props[o])return!0;for(var a in this.props)if(!(a in n))return!0;return!1};function jx(n,e){return tc(function(){return Ze(n,e)},[])}var Qx=function(n){queueMicrotask(function(){queueMicrotask(n)})};function ey(){mf(function(){for(var n;n=Fm.shift();)Om.call(n)})}function km(){Fm.push(this)===1&&(Et.requestAnimationFrame||Qx)(ey)}var _f="placecell-key",yn=class extends Error{constructor(t,i,s,r=null){super(s||i);this.status=t;this.title=i;this.detail=s;this.retryAfter=r}status;title;detail;retryAfter},lc=()=>sessionStorage.getItem(_f)??"",vf=n=>{n?sessionStorage.setItem(_f,n):sessionStorage.removeItem(_f)},_i=(...n)=>n.map(e=>encodeURIComponent(e)).join("/");async function dr(n,e={}){let t=new URL(n,document.baseURI);for(let[l,c]of Object.entries(e.query??{}))if(c!==void 0)for(let u of Array.isArray(c)?c:[c])t.searchParams.append(l,String(u));let i={Accept:"application/json",...e.headers},s=lc();s&&(i.Authorization=`Bearer ${s}`);let r=e.body;e.json!==void 0&&(i["Content-Type"]="application/json",r=JSON.stringify(e.json));let o={method:e.method??"GET",headers:i,cache:"no-store"};r!==void 0&&(o.body=r),e.signal&&(o.signal=e.signal);let a;try{a=await fetch(t,o)}catch(l){throw l instanceof DOMException&&l.name==="AbortError"?l:new yn(0,"No connection","The service does not answer. Check that it runs.")}if(a.ok||a.status===304)return a;throw await ty(a)}async function ty(n){let e=Number(n.headers.get("Retry-After")),t=await n.text().catch(()=>"");try{let i=JSON.parse(t);return new yn(n.status,i.title??`Status ${n.status}`,i.detail??"",e||null)}catch{return new yn(n.status,`Status ${n.status}`,t.slice(0,300),e||null)}}async function Xn(n,e={}){return await(await dr(n,e)).json()}var gt={key:()=>Xn("key"),info:()=>Xn("info"),metrics:async()=>(await dr("metrics",{headers:{Accept:"text/plain"}})).text(),maps:()=>Xn("maps"),map:n=>Xn(_i("maps",n)),shapes:(n,e,t)=>Xn(_i("maps",n,"shapes"),{query:{id:e},signal:t}),versions:async n=>(await Xn(_i("maps",n,"versions"))).versions,restore:(n,e,t,i=!1)=>Xn(_i("maps",n,"versions",e,"restore"),{method:"POST",query:{dry_run:i||void 0},headers:{"If-Match":`"${t}"`}}),versionChanges:async(n,e)=>(await dr(_i("maps",n,"versions",e,"changes"),{headers:{Accept:"*/*"}})).arrayBuffer(),align:(n,e)=>Xn(_i("maps",n,"align",e),{method:"POST",query:{pairs:!0}}),merge:(n,e,t,i)=>Xn(_i("maps",n,"merge"),{method:"POST",json:{maps:e,dry_run:t},headers:i?{"If-Match":`"${i}"`}:{}}),optimize:(n,e,t)=>Xn(_i("maps",n,"optimize"),{method:"POST",query:{dry_run:t||void 0,frames:t||void 0},headers:{"If-Match":`"${e}"`}}),deleteMap:async(n,e)=>{await dr(_i("maps",n),{method:"DELETE",headers:{"If-Match":`"${e}"`}})},prune:(n,e,t)=>Xn(_i("maps",n,"age"),{method:"POST",query:{unseen_since:e,dry_run:t}}),uploadMap:(n,e)=>Xn(_i("maps",n),{method:"PUT",body:e,headers:{"Content-Type":"application/vnd.placecell.map","If-None-Match":"*"}}),addScan:(n,e,t,i)=>Xn(_i("maps",n,"scans"),{method:"POST",body:t,query:{name:t.name,robot:e,...i?{deduplicate:!0,x:i.translation[0],y:i.translation[1],z:i.translation[2],yaw:i.yaw}:{create:!0}},headers:{"Content-Type":"application/octet-stream",...i?{}:{"If-None-Match":"*"}}}),scan:n=>Xn("scans",{method:"POST",body:n,query:{name:n.name},headers:{"Content-Type":"application/octet-stream"}}),match:n=>Xn("match",{method:"POST",json:n}),localize:n=>Xn("localize",{method:"POST",json:n}),robots:async()=>(await Xn("robots")).robots,mapFile:(n,e,t)=>dr(_i("maps",n),{headers:{Accept:"*/*",...e},query:{version:t}}),exportMap:async(n,e)=>(await dr(_i("maps",n,"export"),{query:{to:e},headers:{Accept:"*/*"}})).blob()};async function zm(n,e,t){let i="",s=1;for(;!n.aborted;){try{let r={Accept:"text/event-stream"};i&&(r["Last-Event-ID"]=i);let o=await dr("events",{headers:r,signal:n});t(!0,""),s=1;for await(let a of ny(o.body))a.id&&(i=a.id),a.kind&&e(a);t(!1,"The service closed the stream.")}catch(r){if(n.aborted||(t(!1,r instanceof Error?r.message:String(r)),r instanceof yn&&(r.status===401||r.status===404)))return;s=Math.min(30,2*s)}await new Promise(r=>setTimeout(r,1e3*s))}}async function*ny(n){let e=n.getReader(),t=new TextDecoder,i="";for(;;){let{done:s,value:r}=await e.read();if(s)return;i+=t.decode(r,{stream:!0});let o=i.replaceAll(`\r
`,`
`).split(`

`);i=o.pop()??"";for(let a of o){let l={id:"",kind:"",data:{}},c=[];for(let u of a.split(`
`)){let h=u.indexOf(":");if(h<1)continue;let f=u.slice(h+1).replace(/^ /,""),d=u.slice(0,h);d==="id"&&(l.id=f),d==="event"&&(l.kind=f),d==="data"&&c.push(f)}c.length&&(l.data=JSON.parse(c.join(`
`))),yield l}}}var iy={F64:{bytes:8,make:n=>new Float64Array(n)},F32:{bytes:4,make:n=>new Float32Array(n)},U32:{bytes:4,make:n=>new Uint32Array(n)},U16:{bytes:2,make:n=>new Uint16Array(n)},U8:{bytes:1,make:n=>new Uint8Array(n)},I16:{bytes:2,make:n=>new Int16Array(n)},I8:{bytes:1,make:n=>new Int8Array(n)}},sy=65536;async function cc(n,e,t,i,s){let r={Range:`bytes=${e}-${t}`};i&&(r["If-Range"]=`"${i}"`);let o=await gt.mapFile(n,r,s);return{bytes:await o.arrayBuffer(),etag:(o.headers.get("ETag")??"").replaceAll('"',""),whole:o.status===200}}async function uc(n,e){for(let t=0;t<5;t+=1){let i=await ry(n,e);if(i)return i}throw new yn(0,"Map changes",`The map ${n} changes faster than it can be read.`)}async function ry(n,e){let t=await cc(n,0,sy-1,void 0,e),i=Number(new DataView(t.bytes).getBigUint64(0,!0)),s=new Uint8Array(t.bytes);if(!t.whole&&i+8>s.length){let l=await cc(n,s.length,i+7,t.etag,e);if(l.whole)return null;s=Vm(s,new Uint8Array(l.bytes))}let r=JSON.parse(new TextDecoder().decode(s.subarray(8,8+i))),o=8+i,a=o+r.codes.data_offsets[0];if(!t.whole&&a>s.length){let l=await cc(n,s.length,a-1,t.etag,e);if(l.whole)return null;s=Vm(s,new Uint8Array(l.bytes))}return Gm(n,t.etag,s,r,o)}function Vm(n,e){let t=new Uint8Array(n.length+e.length);return t.set(n),t.set(e,n.length),t}function Gm(n,e,t,i,s){let r=JSON.parse(i.__metadata__.placecell),o=g=>{let y=i[g];if(!y)return null;let p=iy[y.dtype];if(!p)throw new yn(0,"Unknown column",`Column ${g} has type ${y.dtype}.`);let[m,x]=y.data_offsets;return p.make(t.slice(s+m,s+x).buffer)},a=g=>o(g),l=a("frame_positions"),c=a("frame_index"),u=a("centroids"),h=a("ids"),f=new Float64Array(u.length);for(let g=0;g<h.length;g+=1){let y=3*c[g];for(let p=0;p<3;p+=1){let m=Math.round(100*l[y+p]);f[3*g+p]=(m+u[3*g+p])/100}}let d=i.codes;return{name:n,etag:e,frame:r.frame,modelId:r.model_id,ids:h,centroids:f,robots:r.robots,robot:a("robot"),sources:r.sources??[],source:o("source"),seen:o("seen"),views:o("views"),points:o("points"),extents:o("extents"),classes:o("classes"),frameIndex:c,frameTimes:a("frame_times"),framePositions:l,codes:{begin:s+d.data_offsets[0],bytes:d.shape[1]??0}}}function Hm(n,e){let t=new Uint8Array(e),i=Number(new DataView(e).getBigUint64(0,!0)),s=JSON.parse(new TextDecoder().decode(t.subarray(8,8+i))),r=Gm(n,"",t,s,8+i),[o,a]=s.removed.data_offsets,{since:l,until:c}=JSON.parse(s.__metadata__.placecell);return{changed:r,whole:l===0&&(c??0)>0,removed:new Uint32Array(e.slice(8+i+o,8+i+a))}}async function Wm(n,e){let t=n.codes.begin+e*n.codes.bytes,i=await cc(n.name,t,t+n.codes.bytes-1,n.etag);if(i.etag!==n.etag)throw new yn(412,"Map changed","The map has changed. Open it again.");let s=i.whole?i.bytes.slice(t,t+n.codes.bytes):i.bytes;return[...new Int8Array(s)]}function Do(n,e){let[t,i]=[0,n.length];for(;t<i;){let s=t+i>>1;n[s]<e?t=s+1:i=s}return n[t]===e?t:void 0}async function Xm(n){let e=new Uint8Array(await n.slice(0,400).arrayBuffer());return new TextDecoder().decode(e.subarray(8)).startsWith('{"__metadata__":{"placecell":')}var hc=(n,e)=>n.frameTimes[n.frameIndex[e]];var pr=n=>[(n>>16)/255,(n>>8&255)/255,(n&255)/255],xf=[5682409,15113984,40563,15787074,13983232,13400487,29362,12303291].map(pr),fc=[8782,1193328,3885420,5725549,7369075,9078392,10853492,12825449,14797909,16705592].map(pr),Kn=pr(6713981),Gr=pr(5682409),yf=pr(3819088),Hr=pr(13983232),xC=pr(16777215),Jn=pr(15787074);function No(n){let[e,t,i]=xf[n%xf.length],s=[1,.7,.5][Math.floor(n/xf.length)%3];return[e*s,t*s,i*s]}function Wr(n){let e=Math.min(Math.max(n,0),1)*(fc.length-1),t=Math.min(Math.floor(e),fc.length-2),[i,s]=[fc[t],fc[t+1]],r=e-t;return[0,1,2].map(o=>i[o]+r*(s[o]-i[o]))}var ci=([n,e,t])=>`rgb(${Math.round(255*n)} ${Math.round(255*e)} ${Math.round(255*t)})`;var Sf={robot:"robot",origin:"map of origin",age:"age",class:"class",match:"match quality"},dc=["unknown","building","vegetation","trunk or pole","vehicle","person","fence or wall","sign","other"],qm=n=>Math.ceil(n/31);function Ym(n){let e=dc[qm(n)]??"unknown";return n?`${e} (${Math.round((n-1)%31*100/30)}%)`:e}function $m(n,e,t,i,s){let r=n.ids.length,o=(a,l)=>{let c=a.map(u=>s.has(u)?Kn:No(t(u)));return{colors:bf(r,u=>c[l(u)]??Kn),legend:a.map((u,h)=>({label:u,color:ci(c[h])}))}};if(e==="robot")return o(n.robots,a=>n.robot[a]);if(e==="origin"){let{source:a}=n;return a?o([n.name,...n.sources],l=>a[l]):o([n.name],()=>0)}if(e==="class"&&n.classes){let{classes:a}=n;return o(dc,l=>qm(a[l]))}if(e==="age"){let a=h=>Math.max(n.seen?n.seen[h]:0,hc(n,h)),[l,c]=[1/0,-1/0];for(let h=0;h<r;h+=1)l=Math.min(l,a(h)),c=Math.max(c,a(h));let u=Math.max(c-l,1e-9);return{colors:bf(r,h=>Wr((a(h)-l)/u)),legend:r?[{color:ci(Wr(0)),label:`first seen ${ys(l)}`},{color:ci(Wr(1)),label:`last seen ${ys(c)}`}]:[]}}return{colors:bf(r,a=>{let l=i.get(n.ids[a]);return l===void 0?Kn:Wr(.35+.65*l)}),legend:[{color:ci(Kn),label:e==="class"?"this map has no classes":"no match"},...e==="match"?[{color:ci(Wr(.35)),label:"match, probability 0"},{color:ci(Wr(1)),label:"match, probability 1"}]:[]]}}function bf(n,e){let t=new Uint8Array(3*n);for(let i=0;i<n;i+=1){let s=e(i);t[3*i]=255*s[0],t[3*i+1]=255*s[1],t[3*i+2]=255*s[2]}return t}function ys(n){return Math.abs(n)<1e8?`${n.toFixed(1)} s`:new Date(1e3*n).toISOString().slice(0,16).replace("T"," ")}var Gi={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},ns={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},Tg=0,Jf=1,Ag=2;var gl=1,Eg=2,aa=3,Cr=0,pi=1,Ms=2,Jr=0,la=1,jf=2,Qf=3,ed=4,Cg=5;var jr=100,Rg=101,Pg=102,Ig=103,Lg=104,Dg=200,Ng=201,Ug=202,Og=203,td=204,nd=205,Fg=206,Bg=207,kg=208,zg=209,Vg=210,Gg=211,Hg=212,Wg=213,Xg=214,zc=0,Vc=1,Gc=2,Zo=3,Hc=4,Wc=5,Xc=6,qc=7,id=0,qg=1,Yg=2,ws=0,sd=1,rd=2,od=3,ad=4,ld=5,cd=6,ud=7;var hd=300,Qr=301,ca=302,vu=303,xu=304,Yc=1e3,Ss=1001,$c=1002,Vn=1003,$g=1004;var _l=1005;var fi=1006,yu=1007;var Ks=1008;var Ii=1009,fd=1010,dd=1011,ua=1012,bu=1013,is=1014,ss=1015,rs=1016,Su=1017,Mu=1018,eo=1020,pd=35902,md=35899,gd=1021,_d=1022,os=1023,Xs=1026,Js=1027,vd=1028,wu=1029,Rr=1030,Tu=1031;var Au=1033,vl=33776,xl=33777,yl=33778,bl=33779,Eu=35840,Cu=35841,Ru=35842,Pu=35843,Iu=36196,Lu=37492,Du=37496,Nu=37488,Uu=37489,Sl=37490,Ou=37491,Fu=37808,Bu=37809,ku=37810,zu=37811,Vu=37812,Gu=37813,Hu=37814,Wu=37815,Xu=37816,qu=37817,Yu=37818,$u=37819,Zu=37820,Ku=37821,Ju=36492,ju=36494,Qu=36495,eh=36283,th=36284,Ml=36285,nh=36286;var Qa=2300,Zc=2301,Bc=2302,Hf=2303,Wf=2400,Xf=2401,qf=2402;var Zg=3200;var xd=0,Kg=1,js="",Ci="srgb",Zr="srgb-linear",el="linear",Nt="srgb";var kc=7680;var Jg=519,jg=512,Qg=513,e_=514,yd=515,t_=516,n_=517,bd=518,Sd=519,i_=35044;var Md="300 es",ki=2e3,tl=2001;function oy(n){for(let e=n.length-1;e>=0;--e)if(n[e]>=65535)return!0;return!1}function ay(n){return ArrayBuffer.isView(n)&&!(n instanceof DataView)}function nl(n){return document.createElementNS("http://www.w3.org/1999/xhtml",n)}function s_(){let n=nl("canvas");return n.style.display="block",n}var Zm={},Ko=null;function wd(...n){let e="THREE."+n.shift();Ko?Ko("log",e,...n):console.log(e,...n)}function r_(n){let e=n[0];if(typeof e=="string"&&e.startsWith("TSL:")){let t=n[1];t&&t.isStackTrace?n[0]+=" "+t.getLocation():n[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return n}function Ye(...n){n=r_(n);let e="THREE."+n.shift();if(Ko)Ko("warn",e,...n);else{let t=n[0];t&&t.isStackTrace?console.warn(t.getError(e)):console.warn(e,...n)}}function Qe(...n){n=r_(n);let e="THREE."+n.shift();if(Ko)Ko("error",e,...n);else{let t=n[0];t&&t.isStackTrace?console.error(t.getError(e)):console.error(e,...n)}}function Ka(...n){let e=n.join(" ");e in Zm||(Zm[e]=!0,Ye(...n))}function o_(n,e,t){return new Promise(function(i,s){function r(){switch(n.clientWaitSync(e,n.SYNC_FLUSH_COMMANDS_BIT,0)){case n.WAIT_FAILED:s();break;case n.TIMEOUT_EXPIRED:setTimeout(r,t);break;default:i()}}setTimeout(r,t)})}var a_={[zc]:zc,[Gc]:Xc,[Hc]:Hc,[Zo]:Wc,[Vc]:Vc,[Xc]:Gc,[qc]:qc,[Wc]:Zo},es=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let i=this._listeners;i[e]===void 0&&(i[e]=[]),i[e].indexOf(t)===-1&&i[e].push(t)}hasEventListener(e,t){let i=this._listeners;return i===void 0?!1:i[e]!==void 0&&i[e].indexOf(t)!==-1}removeEventListener(e,t){let i=this._listeners;if(i===void 0)return;let s=i[e];if(s!==void 0){let r=s.indexOf(t);r!==-1&&s.splice(r,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let i=t[e.type];if(i!==void 0){e.target=this;let s=i.slice(0);for(let r=0,o=s.length;r<o;r++)s[r].call(this,e);e.target=null}}},jn=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],Km=1234567,Ja=Math.PI/180,Jo=180/Math.PI;function ha(){let n=Math.random()*4294967295|0,e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,i=Math.random()*4294967295|0;return(jn[n&255]+jn[n>>8&255]+jn[n>>16&255]+jn[n>>24&255]+"-"+jn[e&255]+jn[e>>8&255]+"-"+jn[e>>16&15|64]+jn[e>>24&255]+"-"+jn[t&63|128]+jn[t>>8&255]+"-"+jn[t>>16&255]+jn[t>>24&255]+jn[i&255]+jn[i>>8&255]+jn[i>>16&255]+jn[i>>24&255]).toLowerCase()}function vt(n,e,t){return Math.max(e,Math.min(t,n))}function Td(n,e){return(n%e+e)%e}function ly(n,e,t,i,s){return i+(n-e)*(s-i)/(t-e)}function cy(n,e,t){return n!==e?(t-n)/(e-n):0}function ja(n,e,t){return(1-t)*n+t*e}function uy(n,e,t,i){return ja(n,e,1-Math.exp(-t*i))}function hy(n,e=1){return e-Math.abs(Td(n,e*2)-e)}function fy(n,e,t){return n<=e?0:n>=t?1:(n=(n-e)/(t-e),n*n*(3-2*n))}function dy(n,e,t){return n<=e?0:n>=t?1:(n=(n-e)/(t-e),n*n*n*(n*(n*6-15)+10))}function py(n,e){return n+Math.floor(Math.random()*(e-n+1))}function my(n,e){return n+Math.random()*(e-n)}function gy(n){return n*(.5-Math.random())}function _y(n){n!==void 0&&(Km=n);let e=Km+=1831565813;return e=Math.imul(e^e>>>15,e|1),e^=e+Math.imul(e^e>>>7,e|61),((e^e>>>14)>>>0)/4294967296}function vy(n){return n*Ja}function xy(n){return n*Jo}function yy(n){return n>0&&Number.isInteger(n)&&2**Math.round(Math.log2(n))===n}function by(n){return Math.pow(2,Math.ceil(Math.log(n)/Math.LN2))}function Ad(n){return Math.pow(2,Math.floor(Math.log(n)/Math.LN2))}function Sy(n,e,t,i,s){let r=Math.cos,o=Math.sin,a=r(t/2),l=o(t/2),c=r((e+i)/2),u=o((e+i)/2),h=r((e-i)/2),f=o((e-i)/2),d=r((i-e)/2),g=o((i-e)/2);switch(s){case"XYX":n.set(a*u,l*h,l*f,a*c);break;case"YZY":n.set(l*f,a*u,l*h,a*c);break;case"ZXZ":n.set(l*h,l*f,a*u,a*c);break;case"XZX":n.set(a*u,l*g,l*d,a*c);break;case"YXY":n.set(l*d,a*u,l*g,a*c);break;case"ZYZ":n.set(l*g,l*d,a*u,a*c);break;default:Ye("MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function Ed(n){switch(n.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function l_(n,e){if(e.constructor===Float32Array)return n;let t=Ed(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(n/t,-1)}function c_(n,e){if(e.constructor===Float32Array)return n;let t=Ed(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(n*t)}var Cd={DEG2RAD:Ja,RAD2DEG:Jo,generateUUID:ha,clamp:vt,euclideanModulo:Td,mapLinear:ly,inverseLerp:cy,lerp:ja,damp:uy,pingpong:hy,smoothstep:fy,smootherstep:dy,randInt:py,randFloat:my,randFloatSpread:gy,seededRandom:_y,degToRad:vy,radToDeg:xy,isPowerOfTwo:yy,ceilPowerOfTwo:by,floorPowerOfTwo:Ad,setQuaternionFromProperEuler:Sy,normalize:c_,denormalize:l_},tt=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw new Error("THREE.Vector2: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,i=this.y,s=e.elements;return this.x=s[0]*t+s[3]*i+s[6],this.y=s[1]*t+s[4]*i+s[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=vt(this.x,e.x,t.x),this.y=vt(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=vt(this.x,e,t),this.y=vt(this.y,e,t),this}clampLength(e,t){let i=this.length();return this.divideScalar(i||1).multiplyScalar(vt(i,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let i=this.dot(e)/t;return Math.acos(vt(i,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,i=this.y-e.y;return t*t+i*i}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,i){return this.x=e.x+(t.x-e.x)*i,this.y=e.y+(t.y-e.y)*i,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let i=Math.cos(t),s=Math.sin(t),r=this.x-e.x,o=this.y-e.y;return this.x=r*i-o*s+e.x,this.y=r*s+o*i+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},di=class{constructor(e=0,t=0,i=0,s=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=i,this._w=s}static slerpFlat(e,t,i,s,r,o,a){let l=i[s+0],c=i[s+1],u=i[s+2],h=i[s+3],f=r[o+0],d=r[o+1],g=r[o+2],y=r[o+3];if(h!==y||l!==f||c!==d||u!==g){let p=l*f+c*d+u*g+h*y;p<0&&(f=-f,d=-d,g=-g,y=-y,p=-p);let m=1-a;if(p<.9995){let x=Math.acos(p),R=Math.sin(x);m=Math.sin(m*x)/R,a=Math.sin(a*x)/R,l=l*m+f*a,c=c*m+d*a,u=u*m+g*a,h=h*m+y*a}else{l=l*m+f*a,c=c*m+d*a,u=u*m+g*a,h=h*m+y*a;let x=1/Math.sqrt(l*l+c*c+u*u+h*h);l*=x,c*=x,u*=x,h*=x}}e[t]=l,e[t+1]=c,e[t+2]=u,e[t+3]=h}static multiplyQuaternionsFlat(e,t,i,s,r,o){let a=i[s],l=i[s+1],c=i[s+2],u=i[s+3],h=r[o],f=r[o+1],d=r[o+2],g=r[o+3];return e[t]=a*g+u*h+l*d-c*f,e[t+1]=l*g+u*f+c*h-a*d,e[t+2]=c*g+u*d+a*f-l*h,e[t+3]=u*g-a*h-l*f-c*d,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,i,s){return this._x=e,this._y=t,this._z=i,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let i=e._x,s=e._y,r=e._z,o=e._order,a=Math.cos,l=Math.sin,c=a(i/2),u=a(s/2),h=a(r/2),f=l(i/2),d=l(s/2),g=l(r/2);switch(o){case"XYZ":this._x=f*u*h+c*d*g,this._y=c*d*h-f*u*g,this._z=c*u*g+f*d*h,this._w=c*u*h-f*d*g;break;case"YXZ":this._x=f*u*h+c*d*g,this._y=c*d*h-f*u*g,this._z=c*u*g-f*d*h,this._w=c*u*h+f*d*g;break;case"ZXY":this._x=f*u*h-c*d*g,this._y=c*d*h+f*u*g,this._z=c*u*g+f*d*h,this._w=c*u*h-f*d*g;break;case"ZYX":this._x=f*u*h-c*d*g,this._y=c*d*h+f*u*g,this._z=c*u*g-f*d*h,this._w=c*u*h+f*d*g;break;case"YZX":this._x=f*u*h+c*d*g,this._y=c*d*h+f*u*g,this._z=c*u*g-f*d*h,this._w=c*u*h-f*d*g;break;case"XZY":this._x=f*u*h-c*d*g,this._y=c*d*h-f*u*g,this._z=c*u*g+f*d*h,this._w=c*u*h+f*d*g;break;default:Ye("Quaternion: .setFromEuler() encountered an unknown order: "+o)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let i=t/2,s=Math.sin(i);return this._x=e.x*s,this._y=e.y*s,this._z=e.z*s,this._w=Math.cos(i),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,i=t[0],s=t[4],r=t[8],o=t[1],a=t[5],l=t[9],c=t[2],u=t[6],h=t[10],f=i+a+h;if(f>0){let d=.5/Math.sqrt(f+1);this._w=.25/d,this._x=(u-l)*d,this._y=(r-c)*d,this._z=(o-s)*d}else if(i>a&&i>h){let d=2*Math.sqrt(1+i-a-h);this._w=(u-l)/d,this._x=.25*d,this._y=(s+o)/d,this._z=(r+c)/d}else if(a>h){let d=2*Math.sqrt(1+a-i-h);this._w=(r-c)/d,this._x=(s+o)/d,this._y=.25*d,this._z=(l+u)/d}else{let d=2*Math.sqrt(1+h-i-a);this._w=(o-s)/d,this._x=(r+c)/d,this._y=(l+u)/d,this._z=.25*d}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let i=e.dot(t)+1;return i<1e-8?(i=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=i):(this._x=0,this._y=-e.z,this._z=e.y,this._w=i)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=i),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(vt(this.dot(e),-1,1)))}rotateTowards(e,t){let i=this.angleTo(e);if(i===0)return this;let s=Math.min(1,t/i);return this.slerp(e,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x=this._x*e,this._y=this._y*e,this._z=this._z*e,this._w=this._w*e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let i=e._x,s=e._y,r=e._z,o=e._w,a=t._x,l=t._y,c=t._z,u=t._w;return this._x=i*u+o*a+s*c-r*l,this._y=s*u+o*l+r*a-i*c,this._z=r*u+o*c+i*l-s*a,this._w=o*u-i*a-s*l-r*c,this._onChangeCallback(),this}slerp(e,t){let i=e._x,s=e._y,r=e._z,o=e._w,a=this.dot(e);a<0&&(i=-i,s=-s,r=-r,o=-o,a=-a);let l=1-t;if(a<.9995){let c=Math.acos(a),u=Math.sin(c);l=Math.sin(l*c)/u,t=Math.sin(t*c)/u,this._x=this._x*l+i*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+o*t,this._onChangeCallback()}else this._x=this._x*l+i*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+o*t,this.normalize();return this}slerpQuaternions(e,t,i){return this.copy(e).slerp(t,i)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),i=Math.random(),s=Math.sqrt(1-i),r=Math.sqrt(i);return this.set(s*Math.sin(e),s*Math.cos(e),r*Math.sin(t),r*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},V=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,i=0){this.x=e,this.y=t,this.z=i}set(e,t,i){return i===void 0&&(i=this.z),this.x=e,this.y=t,this.z=i,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw new Error("THREE.Vector3: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(Jm.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(Jm.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,i=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[3]*i+r[6]*s,this.y=r[1]*t+r[4]*i+r[7]*s,this.z=r[2]*t+r[5]*i+r[8]*s,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,i=this.y,s=this.z,r=e.elements,o=1/(r[3]*t+r[7]*i+r[11]*s+r[15]);return this.x=(r[0]*t+r[4]*i+r[8]*s+r[12])*o,this.y=(r[1]*t+r[5]*i+r[9]*s+r[13])*o,this.z=(r[2]*t+r[6]*i+r[10]*s+r[14])*o,this}applyQuaternion(e){let t=this.x,i=this.y,s=this.z,r=e.x,o=e.y,a=e.z,l=e.w,c=2*(o*s-a*i),u=2*(a*t-r*s),h=2*(r*i-o*t);return this.x=t+l*c+o*h-a*u,this.y=i+l*u+a*c-r*h,this.z=s+l*h+r*u-o*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,i=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[4]*i+r[8]*s,this.y=r[1]*t+r[5]*i+r[9]*s,this.z=r[2]*t+r[6]*i+r[10]*s,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=vt(this.x,e.x,t.x),this.y=vt(this.y,e.y,t.y),this.z=vt(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=vt(this.x,e,t),this.y=vt(this.y,e,t),this.z=vt(this.z,e,t),this}clampLength(e,t){let i=this.length();return this.divideScalar(i||1).multiplyScalar(vt(i,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,i){return this.x=e.x+(t.x-e.x)*i,this.y=e.y+(t.y-e.y)*i,this.z=e.z+(t.z-e.z)*i,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let i=e.x,s=e.y,r=e.z,o=t.x,a=t.y,l=t.z;return this.x=s*l-r*a,this.y=r*o-i*l,this.z=i*a-s*o,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let i=e.dot(this)/t;return this.copy(e).multiplyScalar(i)}projectOnPlane(e){return Mf.copy(this).projectOnVector(e),this.sub(Mf)}reflect(e){return this.sub(Mf.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let i=this.dot(e)/t;return Math.acos(vt(i,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,i=this.y-e.y,s=this.z-e.z;return t*t+i*i+s*s}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,i){let s=Math.sin(t)*e;return this.x=s*Math.sin(i),this.y=Math.cos(t)*e,this.z=s*Math.cos(i),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,i){return this.x=e*Math.sin(t),this.y=i,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),i=this.setFromMatrixColumn(e,1).length(),s=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=i,this.z=s,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,i=Math.sqrt(1-t*t);return this.x=i*Math.cos(e),this.y=t,this.z=i*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},Mf=new V,Jm=new di,nt=class{static{this.prototype.isMatrix3=!0}constructor(e,t,i,s,r,o,a,l,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,i,s,r,o,a,l,c)}set(e,t,i,s,r,o,a,l,c){let u=this.elements;return u[0]=e,u[1]=s,u[2]=a,u[3]=t,u[4]=r,u[5]=l,u[6]=i,u[7]=o,u[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,i=e.elements;return t[0]=i[0],t[1]=i[1],t[2]=i[2],t[3]=i[3],t[4]=i[4],t[5]=i[5],t[6]=i[6],t[7]=i[7],t[8]=i[8],this}extractBasis(e,t,i){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),i.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let i=e.elements,s=t.elements,r=this.elements,o=i[0],a=i[3],l=i[6],c=i[1],u=i[4],h=i[7],f=i[2],d=i[5],g=i[8],y=s[0],p=s[3],m=s[6],x=s[1],R=s[4],S=s[7],C=s[2],E=s[5],v=s[8];return r[0]=o*y+a*x+l*C,r[3]=o*p+a*R+l*E,r[6]=o*m+a*S+l*v,r[1]=c*y+u*x+h*C,r[4]=c*p+u*R+h*E,r[7]=c*m+u*S+h*v,r[2]=f*y+d*x+g*C,r[5]=f*p+d*R+g*E,r[8]=f*m+d*S+g*v,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],i=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],u=e[8];return t*o*u-t*a*c-i*r*u+i*a*l+s*r*c-s*o*l}invert(){let e=this.elements,t=e[0],i=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],u=e[8],h=u*o-a*c,f=a*l-u*r,d=c*r-o*l,g=t*h+i*f+s*d;if(g===0)return this.set(0,0,0,0,0,0,0,0,0);let y=1/g;return e[0]=h*y,e[1]=(s*c-u*i)*y,e[2]=(a*i-s*o)*y,e[3]=f*y,e[4]=(u*t-s*l)*y,e[5]=(s*r-a*t)*y,e[6]=d*y,e[7]=(i*l-c*t)*y,e[8]=(o*t-i*r)*y,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,i,s,r,o,a){let l=Math.cos(r),c=Math.sin(r);return this.set(i*l,i*c,-i*(l*o+c*a)+o+e,-s*c,s*l,-s*(-c*o+l*a)+a+t,0,0,1),this}scale(e,t){return Ka("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(wf.makeScale(e,t)),this}rotate(e){return Ka("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(wf.makeRotation(-e)),this}translate(e,t){return Ka("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(wf.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),i=Math.sin(e);return this.set(t,-i,0,i,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,i=e.elements;for(let s=0;s<9;s++)if(t[s]!==i[s])return!1;return!0}fromArray(e,t=0){for(let i=0;i<9;i++)this.elements[i]=e[i+t];return this}toArray(e=[],t=0){let i=this.elements;return e[t]=i[0],e[t+1]=i[1],e[t+2]=i[2],e[t+3]=i[3],e[t+4]=i[4],e[t+5]=i[5],e[t+6]=i[6],e[t+7]=i[7],e[t+8]=i[8],e}clone(){return new this.constructor().fromArray(this.elements)}},wf=new nt,jm=new nt().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),Qm=new nt().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function My(){let n={enabled:!0,workingColorSpace:Zr,spaces:{},convert:function(s,r,o){return this.enabled===!1||r===o||!r||!o||(this.spaces[r].transfer===Nt&&(s.r=Ws(s.r),s.g=Ws(s.g),s.b=Ws(s.b)),this.spaces[r].primaries!==this.spaces[o].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[o].fromXYZ)),this.spaces[o].transfer===Nt&&(s.r=$o(s.r),s.g=$o(s.g),s.b=$o(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===js?el:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,r,o){return s.copy(this.spaces[o].fromXYZ).multiply(this.spaces[r].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},e=[.64,.33,.3,.6,.15,.06],t=[.2126,.7152,.0722],i=[.3127,.329];return n.define({[Zr]:{primaries:e,whitePoint:i,transfer:el,toXYZ:jm,fromXYZ:Qm,luminanceCoefficients:t,workingColorSpaceConfig:{unpackColorSpace:Ci},outputColorSpaceConfig:{drawingBufferColorSpace:Ci}},[Ci]:{primaries:e,whitePoint:i,transfer:Nt,toXYZ:jm,fromXYZ:Qm,luminanceCoefficients:t,outputColorSpaceConfig:{drawingBufferColorSpace:Ci}}}),n}var _t=My();function Ws(n){return n<.04045?n*.0773993808:Math.pow(n*.9478672986+.0521327014,2.4)}function $o(n){return n<.0031308?n*12.92:1.055*Math.pow(n,.41666)-.055}var Uo,Kc=class{static getDataURL(e,t="image/png"){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>"u")return e.src;let i;if(e instanceof HTMLCanvasElement)i=e;else{Uo===void 0&&(Uo=nl("canvas")),Uo.width=e.width,Uo.height=e.height;let s=Uo.getContext("2d");e instanceof ImageData?s.putImageData(e,0,0):s.drawImage(e,0,0,e.width,e.height),i=Uo}return i.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<"u"&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&e instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&e instanceof ImageBitmap){let t=nl("canvas");t.width=e.width,t.height=e.height;let i=t.getContext("2d");i.drawImage(e,0,0,e.width,e.height);let s=i.getImageData(0,0,e.width,e.height),r=s.data;for(let o=0;o<r.length;o++)r[o]=Ws(r[o]/255)*255;return i.putImageData(s,0,0),t}else if(e.data){let t=e.data.slice(0);for(let i=0;i<t.length;i++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[i]=Math.floor(Ws(t[i]/255)*255):t[i]=Ws(t[i]);return{data:t,width:e.width,height:e.height}}else return Ye("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),e}},wy=0,jo=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:wy++}),this.uuid=ha(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<"u"&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<"u"&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t!==null?e.set(t.width||0,t.height||0,t.depth||0):e.set(0,0,0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let i={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let o=0,a=s.length;o<a;o++)s[o].isDataTexture?r.push(Tf(s[o].image)):r.push(Tf(s[o]))}else r=Tf(s);i.url=r}return t||(e.images[this.uuid]=i),i}};function Tf(n){return typeof HTMLImageElement<"u"&&n instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&n instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&n instanceof ImageBitmap?Kc.getDataURL(n):n.data?{data:Array.from(n.data),width:n.width,height:n.height,type:n.data.constructor.name}:(Ye("Texture: Unable to serialize Texture."),{})}var Ty=0,Af=new V,vi=class n extends es{constructor(e=n.DEFAULT_IMAGE,t=n.DEFAULT_MAPPING,i=Ss,s=Ss,r=fi,o=Ks,a=os,l=Ii,c=n.DEFAULT_ANISOTROPY,u=js){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:Ty++}),this.uuid=ha(),this.name="",this.source=new jo(e),this.mipmaps=[],this.mapping=t,this.channel=0,this.wrapS=i,this.wrapT=s,this.magFilter=r,this.minFilter=o,this.anisotropy=c,this.format=a,this.internalFormat=null,this.type=l,this.offset=new tt(0,0),this.repeat=new tt(1,1),this.center=new tt(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new nt,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=u,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(e&&e.depth&&e.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(Af).x}get height(){return this.source.getSize(Af).y}get depth(){return this.source.getSize(Af).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let i=e[t];if(i===void 0){Ye(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Ye(`Texture.setValues(): property '${t}' does not exist.`);continue}s&&i&&s.isVector2&&i.isVector2||s&&i&&s.isVector3&&i.isVector3||s&&i&&s.isMatrix3&&i.isMatrix3?s.copy(i):this[t]=i}}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let i={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(i.userData=this.userData),t||(e.textures[this.uuid]=i),i}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(e){if(this.mapping!==hd)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case Yc:e.x=e.x-Math.floor(e.x);break;case Ss:e.x=e.x<0?0:1;break;case $c:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x=e.x-Math.floor(e.x);break}if(e.y<0||e.y>1)switch(this.wrapT){case Yc:e.y=e.y-Math.floor(e.y);break;case Ss:e.y=e.y<0?0:1;break;case $c:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y=e.y-Math.floor(e.y);break}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};vi.DEFAULT_IMAGE=null;vi.DEFAULT_MAPPING=hd;vi.DEFAULT_ANISOTROPY=1;var rn=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,i=0,s=1){this.x=e,this.y=t,this.z=i,this.w=s}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,i,s){return this.x=e,this.y=t,this.z=i,this.w=s,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw new Error("THREE.Vector4: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w!==void 0?e.w:1,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,i=this.y,s=this.z,r=this.w,o=e.elements;return this.x=o[0]*t+o[4]*i+o[8]*s+o[12]*r,this.y=o[1]*t+o[5]*i+o[9]*s+o[13]*r,this.z=o[2]*t+o[6]*i+o[10]*s+o[14]*r,this.w=o[3]*t+o[7]*i+o[11]*s+o[15]*r,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,i,s,r,l=e.elements,c=l[0],u=l[4],h=l[8],f=l[1],d=l[5],g=l[9],y=l[2],p=l[6],m=l[10];if(Math.abs(u-f)<.01&&Math.abs(h-y)<.01&&Math.abs(g-p)<.01){if(Math.abs(u+f)<.1&&Math.abs(h+y)<.1&&Math.abs(g+p)<.1&&Math.abs(c+d+m-3)<.1)return this.set(1,0,0,0),this;t=Math.PI;let R=(c+1)/2,S=(d+1)/2,C=(m+1)/2,E=(u+f)/4,v=(h+y)/4,T=(g+p)/4;return R>S&&R>C?R<.01?(i=0,s=.707106781,r=.707106781):(i=Math.sqrt(R),s=E/i,r=v/i):S>C?S<.01?(i=.707106781,s=0,r=.707106781):(s=Math.sqrt(S),i=E/s,r=T/s):C<.01?(i=.707106781,s=.707106781,r=0):(r=Math.sqrt(C),i=v/r,s=T/r),this.set(i,s,r,t),this}let x=Math.sqrt((p-g)*(p-g)+(h-y)*(h-y)+(f-u)*(f-u));return Math.abs(x)<.001&&(x=1),this.x=(p-g)/x,this.y=(h-y)/x,this.z=(f-u)/x,this.w=Math.acos((c+d+m-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=vt(this.x,e.x,t.x),this.y=vt(this.y,e.y,t.y),this.z=vt(this.z,e.z,t.z),this.w=vt(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=vt(this.x,e,t),this.y=vt(this.y,e,t),this.z=vt(this.z,e,t),this.w=vt(this.w,e,t),this}clampLength(e,t){let i=this.length();return this.divideScalar(i||1).multiplyScalar(vt(i,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,i){return this.x=e.x+(t.x-e.x)*i,this.y=e.y+(t.y-e.y)*i,this.z=e.z+(t.z-e.z)*i,this.w=e.w+(t.w-e.w)*i,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},Jc=class extends es{constructor(e=1,t=1,i={}){super(),i=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:fi,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},i),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=i.depth,this.scissor=new rn(0,0,e,t),this.scissorTest=!1,this.viewport=new rn(0,0,e,t),this.textures=[];let s=i.count;for(let r=0;r<s;r++)this.textures[r]=new vi({width:e,height:t,depth:i.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this._setTextureOptions(i),this.depthBuffer=i.depthBuffer,this.stencilBuffer=i.stencilBuffer,this.resolveColorBuffer=i.resolveColorBuffer,this.resolveDepthBuffer=i.resolveDepthBuffer,this.resolveStencilBuffer=i.resolveStencilBuffer,this.storeMultisampledColorBuffer=i.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=i.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=i.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=i.depthTexture,this.samples=i.samples,this.multiview=i.multiview,this.useArrayDepthTexture=i.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:fi,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let i=0;i<this.textures.length;i++)this.textures[i].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,i=1){if(this.width!==e||this.height!==t||this.depth!==i){this.width=e,this.height=t,this.depth=i;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=e,this.textures[s].image.height=t,this.textures[s].image.depth=i,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,i=e.textures.length;t<i;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let s=Object.assign({},e.textures[t].image);this.textures[t].source=new jo(s)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null)if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture;else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},Ri=class extends Jc{constructor(e=1,t=1,i={}){super(e,t,i),this.isWebGLRenderTarget=!0}},il=class extends vi{constructor(e=null,t=1,i=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:i,depth:s},this.magFilter=Vn,this.minFilter=Vn,this.wrapR=Ss,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}};var jc=class extends vi{constructor(e=null,t=1,i=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:i,depth:s},this.magFilter=Vn,this.minFilter=Vn,this.wrapR=Ss,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}};var Mt=class n{static{this.prototype.isMatrix4=!0}constructor(e,t,i,s,r,o,a,l,c,u,h,f,d,g,y,p){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,i,s,r,o,a,l,c,u,h,f,d,g,y,p)}set(e,t,i,s,r,o,a,l,c,u,h,f,d,g,y,p){let m=this.elements;return m[0]=e,m[4]=t,m[8]=i,m[12]=s,m[1]=r,m[5]=o,m[9]=a,m[13]=l,m[2]=c,m[6]=u,m[10]=h,m[14]=f,m[3]=d,m[7]=g,m[11]=y,m[15]=p,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new n().fromArray(this.elements)}copy(e){let t=this.elements,i=e.elements;return t[0]=i[0],t[1]=i[1],t[2]=i[2],t[3]=i[3],t[4]=i[4],t[5]=i[5],t[6]=i[6],t[7]=i[7],t[8]=i[8],t[9]=i[9],t[10]=i[10],t[11]=i[11],t[12]=i[12],t[13]=i[13],t[14]=i[14],t[15]=i[15],this}copyPosition(e){let t=this.elements,i=e.elements;return t[12]=i[12],t[13]=i[13],t[14]=i[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,i){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),i.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),i.setFromMatrixColumn(this,2),this)}makeBasis(e,t,i){return this.set(e.x,t.x,i.x,0,e.y,t.y,i.y,0,e.z,t.z,i.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,i=e.elements,s=1/Oo.setFromMatrixColumn(e,0).length(),r=1/Oo.setFromMatrixColumn(e,1).length(),o=1/Oo.setFromMatrixColumn(e,2).length();return t[0]=i[0]*s,t[1]=i[1]*s,t[2]=i[2]*s,t[3]=0,t[4]=i[4]*r,t[5]=i[5]*r,t[6]=i[6]*r,t[7]=0,t[8]=i[8]*o,t[9]=i[9]*o,t[10]=i[10]*o,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,i=e.x,s=e.y,r=e.z,o=Math.cos(i),a=Math.sin(i),l=Math.cos(s),c=Math.sin(s),u=Math.cos(r),h=Math.sin(r);if(e.order==="XYZ"){let f=o*u,d=o*h,g=a*u,y=a*h;t[0]=l*u,t[4]=-l*h,t[8]=c,t[1]=d+g*c,t[5]=f-y*c,t[9]=-a*l,t[2]=y-f*c,t[6]=g+d*c,t[10]=o*l}else if(e.order==="YXZ"){let f=l*u,d=l*h,g=c*u,y=c*h;t[0]=f+y*a,t[4]=g*a-d,t[8]=o*c,t[1]=o*h,t[5]=o*u,t[9]=-a,t[2]=d*a-g,t[6]=y+f*a,t[10]=o*l}else if(e.order==="ZXY"){let f=l*u,d=l*h,g=c*u,y=c*h;t[0]=f-y*a,t[4]=-o*h,t[8]=g+d*a,t[1]=d+g*a,t[5]=o*u,t[9]=y-f*a,t[2]=-o*c,t[6]=a,t[10]=o*l}else if(e.order==="ZYX"){let f=o*u,d=o*h,g=a*u,y=a*h;t[0]=l*u,t[4]=g*c-d,t[8]=f*c+y,t[1]=l*h,t[5]=y*c+f,t[9]=d*c-g,t[2]=-c,t[6]=a*l,t[10]=o*l}else if(e.order==="YZX"){let f=o*l,d=o*c,g=a*l,y=a*c;t[0]=l*u,t[4]=y-f*h,t[8]=g*h+d,t[1]=h,t[5]=o*u,t[9]=-a*u,t[2]=-c*u,t[6]=d*h+g,t[10]=f-y*h}else if(e.order==="XZY"){let f=o*l,d=o*c,g=a*l,y=a*c;t[0]=l*u,t[4]=-h,t[8]=c*u,t[1]=f*h+y,t[5]=o*u,t[9]=d*h-g,t[2]=g*h-d,t[6]=a*u,t[10]=y*h+f}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(Ay,e,Ey)}lookAt(e,t,i){let s=this.elements;return Ai.subVectors(e,t),Ai.lengthSq()===0&&(Ai.z=1),Ai.normalize(),mr.crossVectors(i,Ai),mr.lengthSq()===0&&(Math.abs(i.z)===1?Ai.x+=1e-4:Ai.z+=1e-4,Ai.normalize(),mr.crossVectors(i,Ai)),mr.normalize(),pc.crossVectors(Ai,mr),s[0]=mr.x,s[4]=pc.x,s[8]=Ai.x,s[1]=mr.y,s[5]=pc.y,s[9]=Ai.y,s[2]=mr.z,s[6]=pc.z,s[10]=Ai.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let i=e.elements,s=t.elements,r=this.elements,o=i[0],a=i[4],l=i[8],c=i[12],u=i[1],h=i[5],f=i[9],d=i[13],g=i[2],y=i[6],p=i[10],m=i[14],x=i[3],R=i[7],S=i[11],C=i[15],E=s[0],v=s[4],T=s[8],z=s[12],N=s[1],D=s[5],W=s[9],G=s[13],U=s[2],X=s[6],K=s[10],H=s[14],ce=s[3],J=s[7],Q=s[11],se=s[15];return r[0]=o*E+a*N+l*U+c*ce,r[4]=o*v+a*D+l*X+c*J,r[8]=o*T+a*W+l*K+c*Q,r[12]=o*z+a*G+l*H+c*se,r[1]=u*E+h*N+f*U+d*ce,r[5]=u*v+h*D+f*X+d*J,r[9]=u*T+h*W+f*K+d*Q,r[13]=u*z+h*G+f*H+d*se,r[2]=g*E+y*N+p*U+m*ce,r[6]=g*v+y*D+p*X+m*J,r[10]=g*T+y*W+p*K+m*Q,r[14]=g*z+y*G+p*H+m*se,r[3]=x*E+R*N+S*U+C*ce,r[7]=x*v+R*D+S*X+C*J,r[11]=x*T+R*W+S*K+C*Q,r[15]=x*z+R*G+S*H+C*se,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],i=e[4],s=e[8],r=e[12],o=e[1],a=e[5],l=e[9],c=e[13],u=e[2],h=e[6],f=e[10],d=e[14],g=e[3],y=e[7],p=e[11],m=e[15],x=l*d-c*f,R=a*d-c*h,S=a*f-l*h,C=o*d-c*u,E=o*f-l*u,v=o*h-a*u;return t*(y*x-p*R+m*S)-i*(g*x-p*C+m*E)+s*(g*R-y*C+m*v)-r*(g*S-y*E+p*v)}determinantAffine(){let e=this.elements,t=e[0],i=e[4],s=e[8],r=e[1],o=e[5],a=e[9],l=e[2],c=e[6],u=e[10];return t*(o*u-a*c)-i*(r*u-a*l)+s*(r*c-o*l)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,i){let s=this.elements;return e.isVector3?(s[12]=e.x,s[13]=e.y,s[14]=e.z):(s[12]=e,s[13]=t,s[14]=i),this}invert(){let e=this.elements,t=e[0],i=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],u=e[8],h=e[9],f=e[10],d=e[11],g=e[12],y=e[13],p=e[14],m=e[15],x=t*a-i*o,R=t*l-s*o,S=t*c-r*o,C=i*l-s*a,E=i*c-r*a,v=s*c-r*l,T=u*y-h*g,z=u*p-f*g,N=u*m-d*g,D=h*p-f*y,W=h*m-d*y,G=f*m-d*p,U=x*G-R*W+S*D+C*N-E*z+v*T;if(U===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let X=1/U;return e[0]=(a*G-l*W+c*D)*X,e[1]=(s*W-i*G-r*D)*X,e[2]=(y*v-p*E+m*C)*X,e[3]=(f*E-h*v-d*C)*X,e[4]=(l*N-o*G-c*z)*X,e[5]=(t*G-s*N+r*z)*X,e[6]=(p*S-g*v-m*R)*X,e[7]=(u*v-f*S+d*R)*X,e[8]=(o*W-a*N+c*T)*X,e[9]=(i*N-t*W-r*T)*X,e[10]=(g*E-y*S+m*x)*X,e[11]=(h*S-u*E-d*x)*X,e[12]=(a*z-o*D-l*T)*X,e[13]=(t*D-i*z+s*T)*X,e[14]=(y*R-g*C-p*x)*X,e[15]=(u*C-h*R+f*x)*X,this}scale(e){let t=this.elements,i=e.x,s=e.y,r=e.z;return t[0]*=i,t[4]*=s,t[8]*=r,t[1]*=i,t[5]*=s,t[9]*=r,t[2]*=i,t[6]*=s,t[10]*=r,t[3]*=i,t[7]*=s,t[11]*=r,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],i=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],s=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,i,s))}makeTranslation(e,t,i){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,i,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),i=Math.sin(e);return this.set(1,0,0,0,0,t,-i,0,0,i,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),i=Math.sin(e);return this.set(t,0,i,0,0,1,0,0,-i,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),i=Math.sin(e);return this.set(t,-i,0,0,i,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let i=Math.cos(t),s=Math.sin(t),r=1-i,o=e.x,a=e.y,l=e.z,c=r*o,u=r*a;return this.set(c*o+i,c*a-s*l,c*l+s*a,0,c*a+s*l,u*a+i,u*l-s*o,0,c*l-s*a,u*l+s*o,r*l*l+i,0,0,0,0,1),this}makeScale(e,t,i){return this.set(e,0,0,0,0,t,0,0,0,0,i,0,0,0,0,1),this}makeShear(e,t,i,s,r,o){return this.set(1,i,r,0,e,1,o,0,t,s,1,0,0,0,0,1),this}compose(e,t,i){let s=this.elements,r=t._x,o=t._y,a=t._z,l=t._w,c=r+r,u=o+o,h=a+a,f=r*c,d=r*u,g=r*h,y=o*u,p=o*h,m=a*h,x=l*c,R=l*u,S=l*h,C=i.x,E=i.y,v=i.z;return s[0]=(1-(y+m))*C,s[1]=(d+S)*C,s[2]=(g-R)*C,s[3]=0,s[4]=(d-S)*E,s[5]=(1-(f+m))*E,s[6]=(p+x)*E,s[7]=0,s[8]=(g+R)*v,s[9]=(p-x)*v,s[10]=(1-(f+y))*v,s[11]=0,s[12]=e.x,s[13]=e.y,s[14]=e.z,s[15]=1,this}decompose(e,t,i){let s=this.elements;e.x=s[12],e.y=s[13],e.z=s[14];let r=this.determinantAffine();if(r===0)return i.set(1,1,1),t.identity(),this;let o=Oo.set(s[0],s[1],s[2]).length(),a=Oo.set(s[4],s[5],s[6]).length(),l=Oo.set(s[8],s[9],s[10]).length();r<0&&(o=-o),Ki.copy(this);let c=1/o,u=1/a,h=1/l;return Ki.elements[0]*=c,Ki.elements[1]*=c,Ki.elements[2]*=c,Ki.elements[4]*=u,Ki.elements[5]*=u,Ki.elements[6]*=u,Ki.elements[8]*=h,Ki.elements[9]*=h,Ki.elements[10]*=h,t.setFromRotationMatrix(Ki),i.x=o,i.y=a,i.z=l,this}makePerspective(e,t,i,s,r,o,a=ki,l=!1){let c=this.elements,u=2*r/(t-e),h=2*r/(i-s),f=(t+e)/(t-e),d=(i+s)/(i-s),g,y;if(l)g=r/(o-r),y=o*r/(o-r);else if(a===ki)g=-(o+r)/(o-r),y=-2*o*r/(o-r);else if(a===tl)g=-o/(o-r),y=-o*r/(o-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+a);return c[0]=u,c[4]=0,c[8]=f,c[12]=0,c[1]=0,c[5]=h,c[9]=d,c[13]=0,c[2]=0,c[6]=0,c[10]=g,c[14]=y,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,i,s,r,o,a=ki,l=!1){let c=this.elements,u=2/(t-e),h=2/(i-s),f=-(t+e)/(t-e),d=-(i+s)/(i-s),g,y;if(l)g=1/(o-r),y=o/(o-r);else if(a===ki)g=-2/(o-r),y=-(o+r)/(o-r);else if(a===tl)g=-1/(o-r),y=-r/(o-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+a);return c[0]=u,c[4]=0,c[8]=0,c[12]=f,c[1]=0,c[5]=h,c[9]=0,c[13]=d,c[2]=0,c[6]=0,c[10]=g,c[14]=y,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,i=e.elements;for(let s=0;s<16;s++)if(t[s]!==i[s])return!1;return!0}fromArray(e,t=0){for(let i=0;i<16;i++)this.elements[i]=e[i+t];return this}toArray(e=[],t=0){let i=this.elements;return e[t]=i[0],e[t+1]=i[1],e[t+2]=i[2],e[t+3]=i[3],e[t+4]=i[4],e[t+5]=i[5],e[t+6]=i[6],e[t+7]=i[7],e[t+8]=i[8],e[t+9]=i[9],e[t+10]=i[10],e[t+11]=i[11],e[t+12]=i[12],e[t+13]=i[13],e[t+14]=i[14],e[t+15]=i[15],e}},Oo=new V,Ki=new Mt,Ay=new V(0,0,0),Ey=new V(1,1,1),mr=new V,pc=new V,Ai=new V,eg=new Mt,tg=new di,br=class n{constructor(e=0,t=0,i=0,s=n.DEFAULT_ORDER){this.isEuler=!0,this._x=e,this._y=t,this._z=i,this._order=s}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,i,s=this._order){return this._x=e,this._y=t,this._z=i,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,i=!0){let s=e.elements,r=s[0],o=s[4],a=s[8],l=s[1],c=s[5],u=s[9],h=s[2],f=s[6],d=s[10];switch(t){case"XYZ":this._y=Math.asin(vt(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(-u,d),this._z=Math.atan2(-o,r)):(this._x=Math.atan2(f,c),this._z=0);break;case"YXZ":this._x=Math.asin(-vt(u,-1,1)),Math.abs(u)<.9999999?(this._y=Math.atan2(a,d),this._z=Math.atan2(l,c)):(this._y=Math.atan2(-h,r),this._z=0);break;case"ZXY":this._x=Math.asin(vt(f,-1,1)),Math.abs(f)<.9999999?(this._y=Math.atan2(-h,d),this._z=Math.atan2(-o,c)):(this._y=0,this._z=Math.atan2(l,r));break;case"ZYX":this._y=Math.asin(-vt(h,-1,1)),Math.abs(h)<.9999999?(this._x=Math.atan2(f,d),this._z=Math.atan2(l,r)):(this._x=0,this._z=Math.atan2(-o,c));break;case"YZX":this._z=Math.asin(vt(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-u,c),this._y=Math.atan2(-h,r)):(this._x=0,this._y=Math.atan2(a,d));break;case"XZY":this._z=Math.asin(-vt(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(f,c),this._y=Math.atan2(a,r)):(this._x=Math.atan2(-u,d),this._y=0);break;default:Ye("Euler: .setFromRotationMatrix() encountered an unknown order: "+t)}return this._order=t,i===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,i){return eg.makeRotationFromQuaternion(e),this.setFromRotationMatrix(eg,t,i)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return tg.setFromEuler(this),this.setFromQuaternion(tg,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};br.DEFAULT_ORDER="XYZ";var Qo=class{constructor(){this.mask=1}set(e){this.mask=(1<<e|0)>>>0}enable(e){this.mask|=1<<e|0}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e|0}disable(e){this.mask&=~(1<<e|0)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return(this.mask&(1<<e|0))!==0}},Cy=0,ng=new V,Fo=new di,ks=new Mt,mc=new V,Xa=new V,Ry=new V,Py=new di,ig=new V(1,0,0),sg=new V(0,1,0),rg=new V(0,0,1),og={type:"added"},Iy={type:"removed"},Bo={type:"childadded",child:null},Ef={type:"childremoved",child:null},xi=class n extends es{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Cy++}),this.uuid=ha(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=n.DEFAULT_UP.clone();let e=new V,t=new br,i=new di,s=new V(1,1,1);function r(){i.setFromEuler(t,!1)}function o(){t.setFromQuaternion(i,void 0,!1)}t._onChange(r),i._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:e},rotation:{configurable:!0,enumerable:!0,value:t},quaternion:{configurable:!0,enumerable:!0,value:i},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new Mt},normalMatrix:{value:new nt}}),this.matrix=new Mt,this.matrixWorld=new Mt,this.matrixAutoUpdate=n.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=n.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Qo,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return Fo.setFromAxisAngle(e,t),this.quaternion.multiply(Fo),this}rotateOnWorldAxis(e,t){return Fo.setFromAxisAngle(e,t),this.quaternion.premultiply(Fo),this}rotateX(e){return this.rotateOnAxis(ig,e)}rotateY(e){return this.rotateOnAxis(sg,e)}rotateZ(e){return this.rotateOnAxis(rg,e)}translateOnAxis(e,t){return ng.copy(e).applyQuaternion(this.quaternion),this.position.add(ng.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(ig,e)}translateY(e){return this.translateOnAxis(sg,e)}translateZ(e){return this.translateOnAxis(rg,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(ks.copy(this.matrixWorld).invert())}lookAt(e,t,i){e.isVector3?mc.copy(e):mc.set(e,t,i);let s=this.parent;this.updateWorldMatrix(!0,!1),Xa.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?ks.lookAt(Xa,mc,this.up):ks.lookAt(mc,Xa,this.up),this.quaternion.setFromRotationMatrix(ks),s&&(ks.extractRotation(s.matrixWorld),Fo.setFromRotationMatrix(ks),this.quaternion.premultiply(Fo.invert()))}add(e){if(arguments.length>1){for(let t=0;t<arguments.length;t++)this.add(arguments[t]);return this}return e===this?(Qe("Object3D.add: object can't be added as a child of itself.",e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(og),Bo.child=e,this.dispatchEvent(Bo),Bo.child=null):Qe("Object3D.add: object not an instance of THREE.Object3D.",e),this)}remove(e){if(arguments.length>1){for(let i=0;i<arguments.length;i++)this.remove(arguments[i]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(Iy),Ef.child=e,this.dispatchEvent(Ef),Ef.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),ks.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),ks.multiply(e.parent.matrixWorld)),e.applyMatrix4(ks),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(og),Bo.child=e,this.dispatchEvent(Bo),Bo.child=null,this}getObjectById(e){return this.getObjectByProperty("id",e)}getObjectByName(e){return this.getObjectByProperty("name",e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let i=0,s=this.children.length;i<s;i++){let o=this.children[i].getObjectByProperty(e,t);if(o!==void 0)return o}}getObjectsByProperty(e,t,i=[]){this[e]===t&&i.push(this);let s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].getObjectsByProperty(e,t,i);return i}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Xa,e,Ry),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Xa,Py,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let i=0,s=t.length;i<s;i++)t[i].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let i=0,s=t.length;i<s;i++)t[i].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,i=e.y,s=e.z,r=this.matrix.elements;r[12]+=t-r[0]*t-r[4]*i-r[8]*s,r[13]+=i-r[1]*t-r[5]*i-r[9]*s,r[14]+=s-r[2]*t-r[6]*i-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let i=0,s=t.length;i<s;i++)t[i].updateMatrixWorld(e)}updateWorldMatrix(e,t,i=!1){let s=this.parent;if(e===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||i)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,i=!0),t===!0){let r=this.children;for(let o=0,a=r.length;o<a;o++)r[o].updateWorldMatrix(!1,!0,i)}}toJSON(e){let t=e===void 0||typeof e=="string",i={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},i.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(a=>({...a,boundingBox:a.boundingBox?a.boundingBox.toJSON():void 0,boundingSphere:a.boundingSphere?a.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(a=>({...a})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(e),s.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(a,l){return a[l.uuid]===void 0&&(a[l.uuid]=l.toJSON(e)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(e.geometries,this.geometry);let a=this.geometry.parameters;if(a!==void 0&&a.shapes!==void 0){let l=a.shapes;if(Array.isArray(l))for(let c=0,u=l.length;c<u;c++){let h=l[c];r(e.shapes,h)}else r(e.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(e.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let a=[];for(let l=0,c=this.material.length;l<c;l++)a.push(r(e.materials,this.material[l]));s.material=a}else s.material=r(e.materials,this.material);if(this.children.length>0){s.children=[];for(let a=0;a<this.children.length;a++)s.children.push(this.children[a].toJSON(e).object)}if(this.animations.length>0){s.animations=[];for(let a=0;a<this.animations.length;a++){let l=this.animations[a];s.animations.push(r(e.animations,l))}}if(t){let a=o(e.geometries),l=o(e.materials),c=o(e.textures),u=o(e.images),h=o(e.shapes),f=o(e.skeletons),d=o(e.animations),g=o(e.nodes);a.length>0&&(i.geometries=a),l.length>0&&(i.materials=l),c.length>0&&(i.textures=c),u.length>0&&(i.images=u),h.length>0&&(i.shapes=h),f.length>0&&(i.skeletons=f),d.length>0&&(i.animations=d),g.length>0&&(i.nodes=g)}return i.object=s,i;function o(a){let l=[];for(let c in a){let u=a[c];delete u.metadata,l.push(u)}return l}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot!==null?e.pivot.clone():null,this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let i=0;i<e.children.length;i++){let s=e.children[i];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};xi.DEFAULT_UP=new V(0,1,0);xi.DEFAULT_MATRIX_AUTO_UPDATE=!0;xi.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var Qi=class extends xi{constructor(){super(),this.isGroup=!0,this.type="Group"}},Ly={type:"move"},ea=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new Qi,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new Qi,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new V,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new V),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new Qi,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new V,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new V,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let i of e.hand.values())this._getHandJoint(t,i)}return this.dispatchEvent({type:"connected",data:e}),this}disconnect(e){return this.dispatchEvent({type:"disconnected",data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,i){let s=null,r=null,o=null,a=this._targetRay,l=this._grip,c=this._hand;if(e&&t.session.visibilityState!=="visible-blurred"){if(c&&e.hand){o=!0;for(let y of e.hand.values()){let p=t.getJointPose(y,i),m=this._getHandJoint(c,y);p!==null&&(m.matrix.fromArray(p.transform.matrix),m.matrix.decompose(m.position,m.quaternion,m.scale),m.matrixWorldNeedsUpdate=!0,m.jointRadius=p.radius),m.visible=p!==null}let u=c.joints["index-finger-tip"],h=c.joints["thumb-tip"],f=u.position.distanceTo(h.position),d=.02,g=.005;c.inputState.pinching&&f>d+g?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:e.handedness,target:this})):!c.inputState.pinching&&f<=d-g&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:e.handedness,target:this}))}else l!==null&&e.gripSpace&&(r=t.getPose(e.gripSpace,i),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.quaternion,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1,l.eventsEnabled&&l.dispatchEvent({type:"gripUpdated",data:e,target:this})));a!==null&&(s=t.getPose(e.targetRaySpace,i),s===null&&r!==null&&(s=r),s!==null&&(a.matrix.fromArray(s.transform.matrix),a.matrix.decompose(a.position,a.quaternion,a.scale),a.matrixWorldNeedsUpdate=!0,s.linearVelocity?(a.hasLinearVelocity=!0,a.linearVelocity.copy(s.linearVelocity)):a.hasLinearVelocity=!1,s.angularVelocity?(a.hasAngularVelocity=!0,a.angularVelocity.copy(s.angularVelocity)):a.hasAngularVelocity=!1,this.dispatchEvent(Ly)))}return a!==null&&(a.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=o!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let i=new Qi;i.matrixAutoUpdate=!1,i.visible=!1,e.joints[t.jointName]=i,e.add(i)}return e.joints[t.jointName]}},u_={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},gr={h:0,s:0,l:0},gc={h:0,s:0,l:0};function Cf(n,e,t){return t<0&&(t+=1),t>1&&(t-=1),t<1/6?n+(e-n)*6*t:t<1/2?e:t<2/3?n+(e-n)*6*(2/3-t):n}var yt=class{constructor(e,t,i){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,i)}set(e,t,i){if(t===void 0&&i===void 0){let s=e;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(e,t,i);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=Ci){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,_t.colorSpaceToWorking(this,t),this}setRGB(e,t,i,s=_t.workingColorSpace){return this.r=e,this.g=t,this.b=i,_t.colorSpaceToWorking(this,s),this}setHSL(e,t,i,s=_t.workingColorSpace){if(e=Td(e,1),t=vt(t,0,1),i=vt(i,0,1),t===0)this.r=this.g=this.b=i;else{let r=i<=.5?i*(1+t):i+t-i*t,o=2*i-r;this.r=Cf(o,r,e+1/3),this.g=Cf(o,r,e),this.b=Cf(o,r,e-1/3)}return _t.colorSpaceToWorking(this,s),this}setStyle(e,t=Ci){function i(r){r!==void 0&&parseFloat(r)<1&&Ye("Color: Alpha component of "+e+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(e)){let r,o=s[1],a=s[2];switch(o){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return i(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,t);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return i(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,t);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return i(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,t);break;default:Ye("Color: Unknown color model "+e)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(e)){let r=s[1],o=r.length;if(o===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,t);if(o===6)return this.setHex(parseInt(r,16),t);Ye("Color: Invalid hex color "+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=Ci){let i=u_[e.toLowerCase()];return i!==void 0?this.setHex(i,t):Ye("Color: Unknown color "+e),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=Ws(e.r),this.g=Ws(e.g),this.b=Ws(e.b),this}copyLinearToSRGB(e){return this.r=$o(e.r),this.g=$o(e.g),this.b=$o(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=Ci){return _t.workingToColorSpace(Qn.copy(this),e),Math.round(vt(Qn.r*255,0,255))*65536+Math.round(vt(Qn.g*255,0,255))*256+Math.round(vt(Qn.b*255,0,255))}getHexString(e=Ci){return("000000"+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=_t.workingColorSpace){_t.workingToColorSpace(Qn.copy(this),t);let i=Qn.r,s=Qn.g,r=Qn.b,o=Math.max(i,s,r),a=Math.min(i,s,r),l,c,u=(a+o)/2;if(a===o)l=0,c=0;else{let h=o-a;switch(c=u<=.5?h/(o+a):h/(2-o-a),o){case i:l=(s-r)/h+(s<r?6:0);break;case s:l=(r-i)/h+2;break;case r:l=(i-s)/h+4;break}l/=6}return e.h=l,e.s=c,e.l=u,e}getRGB(e,t=_t.workingColorSpace){return _t.workingToColorSpace(Qn.copy(this),t),e.r=Qn.r,e.g=Qn.g,e.b=Qn.b,e}getStyle(e=Ci){_t.workingToColorSpace(Qn.copy(this),e);let t=Qn.r,i=Qn.g,s=Qn.b;return e!==Ci?`color(${e} ${t.toFixed(3)} ${i.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(t*255)},${Math.round(i*255)},${Math.round(s*255)})`}offsetHSL(e,t,i){return this.getHSL(gr),this.setHSL(gr.h+e,gr.s+t,gr.l+i)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,i){return this.r=e.r+(t.r-e.r)*i,this.g=e.g+(t.g-e.g)*i,this.b=e.b+(t.b-e.b)*i,this}lerpHSL(e,t){this.getHSL(gr),e.getHSL(gc);let i=ja(gr.h,gc.h,t),s=ja(gr.s,gc.s,t),r=ja(gr.l,gc.l,t);return this.setHSL(i,s,r),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,i=this.g,s=this.b,r=e.elements;return this.r=r[0]*t+r[3]*i+r[6]*s,this.g=r[1]*t+r[4]*i+r[7]*s,this.b=r[2]*t+r[5]*i+r[8]*s,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Qn=new yt;yt.NAMES=u_;var sl=class extends xi{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new br,this.environmentIntensity=1,this.environmentRotation=new br,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background!==null?e.background.clone():null,this.environment=e.environment!==null?e.environment.clone():null,this.fog=e.fog!==null?e.fog.clone():null,this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial!==null?e.overrideMaterial.clone():null,this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},Ji=new V,zs=new V,Rf=new V,Vs=new V,ko=new V,zo=new V,ag=new V,Pf=new V,If=new V,Lf=new V,Df=new rn,Nf=new rn,Uf=new rn,yr=class n{constructor(e=new V,t=new V,i=new V){this.a=e,this.b=t,this.c=i}static getNormal(e,t,i,s){s.subVectors(i,t),Ji.subVectors(e,t),s.cross(Ji);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(e,t,i,s,r){Ji.subVectors(s,t),zs.subVectors(i,t),Rf.subVectors(e,t);let o=Ji.dot(Ji),a=Ji.dot(zs),l=Ji.dot(Rf),c=zs.dot(zs),u=zs.dot(Rf),h=o*c-a*a;if(h===0)return r.set(0,0,0),null;let f=1/h,d=(c*l-a*u)*f,g=(o*u-a*l)*f;return r.set(1-d-g,g,d)}static containsPoint(e,t,i,s){return this.getBarycoord(e,t,i,s,Vs)===null?!1:Vs.x>=0&&Vs.y>=0&&Vs.x+Vs.y<=1}static getInterpolation(e,t,i,s,r,o,a,l){return this.getBarycoord(e,t,i,s,Vs)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,Vs.x),l.addScaledVector(o,Vs.y),l.addScaledVector(a,Vs.z),l)}static getInterpolatedAttribute(e,t,i,s,r,o){return Df.setScalar(0),Nf.setScalar(0),Uf.setScalar(0),Df.fromBufferAttribute(e,t),Nf.fromBufferAttribute(e,i),Uf.fromBufferAttribute(e,s),o.setScalar(0),o.addScaledVector(Df,r.x),o.addScaledVector(Nf,r.y),o.addScaledVector(Uf,r.z),o}static isFrontFacing(e,t,i,s){return Ji.subVectors(i,t),zs.subVectors(e,t),Ji.cross(zs).dot(s)<0}set(e,t,i){return this.a.copy(e),this.b.copy(t),this.c.copy(i),this}setFromPointsAndIndices(e,t,i,s){return this.a.copy(e[t]),this.b.copy(e[i]),this.c.copy(e[s]),this}setFromAttributeAndIndices(e,t,i,s){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,i),this.c.fromBufferAttribute(e,s),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return Ji.subVectors(this.c,this.b),zs.subVectors(this.a,this.b),Ji.cross(zs).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(e){return n.getNormal(this.a,this.b,this.c,e)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(e,t){return n.getBarycoord(e,this.a,this.b,this.c,t)}getInterpolation(e,t,i,s,r){return n.getInterpolation(e,this.a,this.b,this.c,t,i,s,r)}containsPoint(e){return n.containsPoint(e,this.a,this.b,this.c)}isFrontFacing(e){return n.isFrontFacing(this.a,this.b,this.c,e)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let i=this.a,s=this.b,r=this.c,o,a;ko.subVectors(s,i),zo.subVectors(r,i),Pf.subVectors(e,i);let l=ko.dot(Pf),c=zo.dot(Pf);if(l<=0&&c<=0)return t.copy(i);If.subVectors(e,s);let u=ko.dot(If),h=zo.dot(If);if(u>=0&&h<=u)return t.copy(s);let f=l*h-u*c;if(f<=0&&l>=0&&u<=0&&l-u>0)return o=l/(l-u),t.copy(i).addScaledVector(ko,o);Lf.subVectors(e,r);let d=ko.dot(Lf),g=zo.dot(Lf);if(g>=0&&d<=g)return t.copy(r);let y=d*c-l*g;if(y<=0&&c>=0&&g<=0)return a=c/(c-g),t.copy(i).addScaledVector(zo,a);let p=u*g-d*h;if(p<=0&&h-u>=0&&d-g>=0)return ag.subVectors(r,s),a=(h-u)/(h-u+(d-g)),t.copy(s).addScaledVector(ag,a);let m=1/(p+y+f);return o=y*m,a=f*m,t.copy(i).addScaledVector(ko,o).addScaledVector(zo,a)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},ts=class{constructor(e=new V(1/0,1/0,1/0),t=new V(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,i=e.length;t<i;t+=3)this.expandByPoint(ji.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,i=e.count;t<i;t++)this.expandByPoint(ji.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,i=e.length;t<i;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let i=ji.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(i),this.max.copy(e).add(i),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let i=e.geometry;if(i!==void 0){let r=i.getAttribute("position");if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let o=0,a=r.count;o<a;o++)e.isMesh===!0?e.getVertexPosition(o,ji):ji.fromBufferAttribute(r,o),ji.applyMatrix4(e.matrixWorld),this.expandByPoint(ji);else e.boundingBox!==void 0?(e.boundingBox===null&&e.computeBoundingBox(),_c.copy(e.boundingBox)):(i.boundingBox===null&&i.computeBoundingBox(),_c.copy(i.boundingBox)),_c.applyMatrix4(e.matrixWorld),this.union(_c)}let s=e.children;for(let r=0,o=s.length;r<o;r++)this.expandByObject(s[r],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,ji),ji.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,i;return e.normal.x>0?(t=e.normal.x*this.min.x,i=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,i=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,i+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,i+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,i+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,i+=e.normal.z*this.min.z),t<=-e.constant&&i>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(qa),vc.subVectors(this.max,qa),Vo.subVectors(e.a,qa),Go.subVectors(e.b,qa),Ho.subVectors(e.c,qa),_r.subVectors(Go,Vo),vr.subVectors(Ho,Go),Xr.subVectors(Vo,Ho);let t=[0,-_r.z,_r.y,0,-vr.z,vr.y,0,-Xr.z,Xr.y,_r.z,0,-_r.x,vr.z,0,-vr.x,Xr.z,0,-Xr.x,-_r.y,_r.x,0,-vr.y,vr.x,0,-Xr.y,Xr.x,0];return!Of(t,Vo,Go,Ho,vc)||(t=[1,0,0,0,1,0,0,0,1],!Of(t,Vo,Go,Ho,vc))?!1:(xc.crossVectors(_r,vr),t=[xc.x,xc.y,xc.z],Of(t,Vo,Go,Ho,vc))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,ji).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(ji).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()?this:(Gs[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),Gs[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),Gs[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),Gs[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),Gs[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),Gs[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),Gs[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),Gs[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(Gs),this)}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},Gs=[new V,new V,new V,new V,new V,new V,new V,new V],ji=new V,_c=new ts,Vo=new V,Go=new V,Ho=new V,_r=new V,vr=new V,Xr=new V,qa=new V,vc=new V,xc=new V,qr=new V;function Of(n,e,t,i,s){for(let r=0,o=n.length-3;r<=o;r+=3){qr.fromArray(n,r);let a=s.x*Math.abs(qr.x)+s.y*Math.abs(qr.y)+s.z*Math.abs(qr.z),l=e.dot(qr),c=t.dot(qr),u=i.dot(qr);if(Math.max(-Math.max(l,c,u),Math.min(l,c,u))>a)return!1}return!0}var bn=new V,yc=new tt,Dy=0,Sn=class extends es{constructor(e,t,i=!1){if(super(),Array.isArray(e))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Dy++}),this.name="",this.array=e,this.itemSize=t,this.count=e!==void 0?e.length/t:0,this.normalized=i,this.usage=i_,this.updateRanges=[],this.gpuType=ss,this.version=0,this._normalizationScale=e!==void 0?Ed(e):void 0}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,i){e*=this.itemSize,i*=t.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[e+s]=t.array[i+s];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,i=this.count;t<i;t++)yc.fromBufferAttribute(this,t),yc.applyMatrix3(e),this.setXY(t,yc.x,yc.y);else if(this.itemSize===3)for(let t=0,i=this.count;t<i;t++)bn.fromBufferAttribute(this,t),bn.applyMatrix3(e),this.setXYZ(t,bn.x,bn.y,bn.z);return this}applyMatrix4(e){for(let t=0,i=this.count;t<i;t++)bn.fromBufferAttribute(this,t),bn.applyMatrix4(e),this.setXYZ(t,bn.x,bn.y,bn.z);return this}applyNormalMatrix(e){for(let t=0,i=this.count;t<i;t++)bn.fromBufferAttribute(this,t),bn.applyNormalMatrix(e),this.setXYZ(t,bn.x,bn.y,bn.z);return this}transformDirection(e){for(let t=0,i=this.count;t<i;t++)bn.fromBufferAttribute(this,t),bn.transformDirection(e),this.setXYZ(t,bn.x,bn.y,bn.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let i=this.array[e*this.itemSize+t];return this.normalized&&(i=this._denormalize(i)),i}setComponent(e,t,i){return this.normalized&&(i=this._normalize(i)),this.array[e*this.itemSize+t]=i,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,i){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),i=this._normalize(i)),this.array[e+0]=t,this.array[e+1]=i,this}setXYZ(e,t,i,s){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),i=this._normalize(i),s=this._normalize(s)),this.array[e+0]=t,this.array[e+1]=i,this.array[e+2]=s,this}setXYZW(e,t,i,s,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),i=this._normalize(i),s=this._normalize(s),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=i,this.array[e+2]=s,this.array[e+3]=r,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(e){let t=this._normalizationScale;return t!==void 0?Math.max(e/t,-1):l_(e,this.array)}_normalize(e){let t=this._normalizationScale;return t!==void 0?Math.round(e*t):c_(e,this.array)}};var rl=class extends Sn{constructor(e,t,i){super(new Uint16Array(e),t,i)}};var ol=class extends Sn{constructor(e,t,i){super(new Uint32Array(e),t,i)}};var qn=class extends Sn{constructor(e,t,i){super(new Float32Array(e),t,i)}},Ny=new ts,Ya=new V,Ff=new V,Sr=class{constructor(e=new V,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let i=this.center;t!==void 0?i.copy(t):Ny.setFromPoints(e).getCenter(i);let s=0;for(let r=0,o=e.length;r<o;r++)s=Math.max(s,i.distanceToSquared(e[r]));return this.radius=Math.sqrt(s),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let i=this.center.distanceToSquared(e);return t.copy(e),i>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius=this.radius*e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;Ya.subVectors(e,this.center);let t=Ya.lengthSq();if(t>this.radius*this.radius){let i=Math.sqrt(t),s=(i-this.radius)*.5;this.center.addScaledVector(Ya,s/i),this.radius+=s}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(Ff.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(Ya.copy(e.center).add(Ff)),this.expandByPoint(Ya.copy(e.center).sub(Ff))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},Uy=0,Bi=new Mt,Bf=new xi,Wo=new V,Ei=new ts,$a=new ts,zn=new V,Gn=class n extends es{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:Uy++}),this.uuid=ha(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return Array.isArray(e)?this.index=new(oy(e)?ol:rl)(e,1):this.index=e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,i=0){this.groups.push({start:e,count:t,materialIndex:i})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let i=this.attributes.normal;if(i!==void 0){let r=new nt().getNormalMatrix(e);i.applyNormalMatrix(r),i.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(e),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return Bi.makeRotationFromQuaternion(e),this.applyMatrix4(Bi),this}rotateX(e){return Bi.makeRotationX(e),this.applyMatrix4(Bi),this}rotateY(e){return Bi.makeRotationY(e),this.applyMatrix4(Bi),this}rotateZ(e){return Bi.makeRotationZ(e),this.applyMatrix4(Bi),this}translate(e,t,i){return Bi.makeTranslation(e,t,i),this.applyMatrix4(Bi),this}scale(e,t,i){return Bi.makeScale(e,t,i),this.applyMatrix4(Bi),this}lookAt(e){return Bf.lookAt(e),Bf.updateMatrix(),this.applyMatrix4(Bf.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(Wo).negate(),this.translate(Wo.x,Wo.y,Wo.z),this}setFromPoints(e){let t=this.getAttribute("position");if(t===void 0){let i=[];for(let s=0,r=e.length;s<r;s++){let o=e[s];i.push(o.x,o.y,o.z||0)}this.setAttribute("position",new qn(i,3))}else{let i=Math.min(e.length,t.count);for(let s=0;s<i;s++){let r=e[s];t.setXYZ(s,r.x,r.y,r.z||0)}e.length>t.count&&Ye("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new ts);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Qe("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new V(-1/0,-1/0,-1/0),new V(1/0,1/0,1/0));return}if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let i=0,s=t.length;i<s;i++){let r=t[i];Ei.setFromBufferAttribute(r),this.morphTargetsRelative?(zn.addVectors(this.boundingBox.min,Ei.min),this.boundingBox.expandByPoint(zn),zn.addVectors(this.boundingBox.max,Ei.max),this.boundingBox.expandByPoint(zn)):(this.boundingBox.expandByPoint(Ei.min),this.boundingBox.expandByPoint(Ei.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&Qe('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new Sr);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Qe("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new V,1/0);return}if(e){let i=this.boundingSphere.center;if(Ei.setFromBufferAttribute(e),t)for(let r=0,o=t.length;r<o;r++){let a=t[r];$a.setFromBufferAttribute(a),this.morphTargetsRelative?(zn.addVectors(Ei.min,$a.min),Ei.expandByPoint(zn),zn.addVectors(Ei.max,$a.max),Ei.expandByPoint(zn)):(Ei.expandByPoint($a.min),Ei.expandByPoint($a.max))}Ei.getCenter(i);let s=0;for(let r=0,o=e.count;r<o;r++)zn.fromBufferAttribute(e,r),s=Math.max(s,i.distanceToSquared(zn));if(t)for(let r=0,o=t.length;r<o;r++){let a=t[r],l=this.morphTargetsRelative;for(let c=0,u=a.count;c<u;c++)zn.fromBufferAttribute(a,c),l&&(Wo.fromBufferAttribute(e,c),zn.add(Wo)),s=Math.max(s,i.distanceToSquared(zn))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&Qe('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){Qe("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let i=t.position,s=t.normal,r=t.uv,o=this.getAttribute("tangent");(o===void 0||o.count!==i.count)&&(o=new Sn(new Float32Array(4*i.count),4),this.setAttribute("tangent",o));let a=[],l=[],c=new Uint8Array(i.count);for(let z=0;z<i.count;z++)a[z]=new V,l[z]=new V;let u=new V,h=new V,f=new V,d=new tt,g=new tt,y=new tt,p=new V,m=new V;function x(z,N,D){c[z]=c[N]=c[D]=1,u.fromBufferAttribute(i,z),h.fromBufferAttribute(i,N),f.fromBufferAttribute(i,D),d.fromBufferAttribute(r,z),g.fromBufferAttribute(r,N),y.fromBufferAttribute(r,D),h.sub(u),f.sub(u),g.sub(d),y.sub(d);let W=1/(g.x*y.y-y.x*g.y);isFinite(W)&&(p.copy(h).multiplyScalar(y.y).addScaledVector(f,-g.y).multiplyScalar(W),m.copy(f).multiplyScalar(g.x).addScaledVector(h,-y.x).multiplyScalar(W),a[z].add(p),a[N].add(p),a[D].add(p),l[z].add(m),l[N].add(m),l[D].add(m))}let R=this.groups;R.length===0&&(R=[{start:0,count:e.count}]);for(let z=0,N=R.length;z<N;++z){let D=R[z],W=D.start,G=D.count;for(let U=W,X=W+G;U<X;U+=3)x(e.getX(U+0),e.getX(U+1),e.getX(U+2))}let S=new V,C=new V,E=new V,v=new V;function T(z){E.fromBufferAttribute(s,z),v.copy(E);let N=a[z];S.copy(N),S.sub(E.multiplyScalar(E.dot(N))).normalize(),C.crossVectors(v,N);let W=C.dot(l[z])<0?-1:1;o.setXYZW(z,S.x,S.y,S.z,W)}for(let z=0,N=i.count;z<N;++z)c[z]&&T(z);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute("position");if(t!==void 0){let i=this.getAttribute("normal");if(i===void 0||i.count!==t.count)i=new Sn(new Float32Array(t.count*3),3),this.setAttribute("normal",i);else for(let f=0,d=i.count;f<d;f++)i.setXYZ(f,0,0,0);let s=new V,r=new V,o=new V,a=new V,l=new V,c=new V,u=new V,h=new V;if(e)for(let f=0,d=e.count;f<d;f+=3){let g=e.getX(f+0),y=e.getX(f+1),p=e.getX(f+2);s.fromBufferAttribute(t,g),r.fromBufferAttribute(t,y),o.fromBufferAttribute(t,p),u.subVectors(o,r),h.subVectors(s,r),u.cross(h),a.fromBufferAttribute(i,g),l.fromBufferAttribute(i,y),c.fromBufferAttribute(i,p),a.add(u),l.add(u),c.add(u),i.setXYZ(g,a.x,a.y,a.z),i.setXYZ(y,l.x,l.y,l.z),i.setXYZ(p,c.x,c.y,c.z)}else for(let f=0,d=t.count;f<d;f+=3)s.fromBufferAttribute(t,f+0),r.fromBufferAttribute(t,f+1),o.fromBufferAttribute(t,f+2),u.subVectors(o,r),h.subVectors(s,r),u.cross(h),i.setXYZ(f+0,u.x,u.y,u.z),i.setXYZ(f+1,u.x,u.y,u.z),i.setXYZ(f+2,u.x,u.y,u.z);this.normalizeNormals(),i.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,i=e.count;t<i;t++)zn.fromBufferAttribute(e,t),zn.normalize(),e.setXYZ(t,zn.x,zn.y,zn.z)}toNonIndexed(){function e(a,l){let c=a.array,u=a.itemSize,h=a.normalized,f=new c.constructor(l.length*u),d=0,g=0;for(let y=0,p=l.length;y<p;y++){a.isInterleavedBufferAttribute?d=l[y]*a.data.stride+a.offset:d=l[y]*u;for(let m=0;m<u;m++)f[g++]=c[d++]}return new Sn(f,u,h)}if(this.index===null)return Ye("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let t=new n,i=this.index.array,s=this.attributes;for(let a in s){let l=s[a],c=e(l,i);t.setAttribute(a,c)}let r=this.morphAttributes;for(let a in r){let l=[],c=r[a];for(let u=0,h=c.length;u<h;u++){let f=c[u],d=e(f,i);l.push(d)}t.morphAttributes[a]=l}t.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let a=0,l=o.length;a<l;a++){let c=o[a];t.addGroup(c.start,c.count,c.materialIndex)}return t}toJSON(){let e={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let l=this.parameters;for(let c in l)l[c]!==void 0&&(e[c]=l[c]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let i=this.attributes;for(let l in i){let c=i[l];e.data.attributes[l]=c.toJSON(e.data)}let s={},r=!1;for(let l in this.morphAttributes){let c=this.morphAttributes[l],u=[];for(let h=0,f=c.length;h<f;h++){let d=c[h];u.push(d.toJSON(e.data))}u.length>0&&(s[l]=u,r=!0)}r&&(e.data.morphAttributes=s,e.data.morphTargetsRelative=this.morphTargetsRelative);let o=this.groups;o.length>0&&(e.data.groups=JSON.parse(JSON.stringify(o)));let a=this.boundingSphere;return a!==null&&(e.data.boundingSphere=a.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let i=e.index;i!==null&&this.setIndex(i.clone());let s=e.attributes;for(let c in s){let u=s[c];this.setAttribute(c,u.clone(t))}let r=e.morphAttributes;for(let c in r){let u=[],h=r[c];for(let f=0,d=h.length;f<d;f++)u.push(h[f].clone(t));this.morphAttributes[c]=u}this.morphTargetsRelative=e.morphTargetsRelative;let o=e.groups;for(let c=0,u=o.length;c<u;c++){let h=o[c];this.addGroup(h.start,h.count,h.materialIndex)}let a=e.boundingBox;a!==null&&(this.boundingBox=a.clone());let l=e.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}};var kf=new V,Oy=new V,Fy=new nt,ui=class{constructor(e=new V(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,i,s){return this.normal.set(e,t,i),this.constant=s,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,i){let s=kf.subVectors(i,t).cross(Oy.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(s,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,i=!0){let s=e.delta(kf),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let o=-(e.start.dot(this.normal)+this.constant)/r;return i===!0&&(o<0||o>1)?null:t.copy(e.start).addScaledVector(s,o)}intersectsLine(e){let t=this.distanceToPoint(e.start),i=this.distanceToPoint(e.end);return t<0&&i>0||i<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let i=t||Fy.getNormalMatrix(e),s=this.coplanarPoint(kf).applyMatrix4(e),r=this.normal.applyMatrix3(i).normalize();return this.constant=-s.dot(r),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},By=0,qs=class extends es{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:By++}),this.uuid=ha(),this.name="",this.type="Material",this.blending=la,this.side=Cr,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=td,this.blendDst=nd,this.blendEquation=jr,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new yt(0,0,0),this.blendAlpha=0,this.depthFunc=Zo,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=Jg,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=kc,this.stencilZFail=kc,this.stencilZPass=kc,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let i=e[t];if(i===void 0){Ye(`Material: parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Ye(`Material: '${t}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(i):s&&s.isVector2&&i&&i.isVector2||s&&s.isEuler&&i&&i.isEuler||s&&s.isVector3&&i&&i.isVector3?s.copy(i):this[t]=i}}toJSON(e){let t=e===void 0||typeof e=="string";t&&(e={textures:{},images:{}});let i={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};i.uuid=this.uuid,i.type=this.type,i.blending=this.blending,i.side=this.side,i.shadowSide=this.shadowSide,i.vertexColors=this.vertexColors,i.opacity=this.opacity,i.transparent=this.transparent,i.blendSrc=this.blendSrc,i.blendDst=this.blendDst,i.blendEquation=this.blendEquation,i.blendSrcAlpha=this.blendSrcAlpha,i.blendDstAlpha=this.blendDstAlpha,i.blendEquationAlpha=this.blendEquationAlpha,i.blendColor=this.blendColor.getHex(),i.blendAlpha=this.blendAlpha,i.depthFunc=this.depthFunc,i.depthTest=this.depthTest,i.depthWrite=this.depthWrite,i.colorWrite=this.colorWrite,i.clipIntersection=this.clipIntersection,i.clipShadows=this.clipShadows,i.stencilWriteMask=this.stencilWriteMask,i.stencilFunc=this.stencilFunc,i.stencilRef=this.stencilRef,i.stencilFuncMask=this.stencilFuncMask,i.stencilFail=this.stencilFail,i.stencilZFail=this.stencilZFail,i.stencilZPass=this.stencilZPass,i.stencilWrite=this.stencilWrite,i.polygonOffset=this.polygonOffset,i.polygonOffsetFactor=this.polygonOffsetFactor,i.polygonOffsetUnits=this.polygonOffsetUnits,i.dithering=this.dithering,i.alphaTest=this.alphaTest,i.alphaHash=this.alphaHash,i.alphaToCoverage=this.alphaToCoverage,i.premultipliedAlpha=this.premultipliedAlpha,i.forceSinglePass=this.forceSinglePass,i.allowOverride=this.allowOverride,i.visible=this.visible,i.toneMapped=this.toneMapped,i.name=this.name,this.color&&this.color.isColor&&(i.color=this.color.getHex()),this.roughness!==void 0&&(i.roughness=this.roughness),this.metalness!==void 0&&(i.metalness=this.metalness),this.sheen!==void 0&&(i.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(i.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(i.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(i.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(i.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(i.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(i.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(i.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(i.shininess=this.shininess),this.clearcoat!==void 0&&(i.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(i.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(i.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(i.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(i.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(i.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(i.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,i.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(i.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(i.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(i.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(i.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(i.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(i.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(i.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(i.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(i.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(i.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(i.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(i.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(i.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(i.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(i.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(i.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(i.lightMap=this.lightMap.toJSON(e).uuid,i.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(i.aoMap=this.aoMap.toJSON(e).uuid,i.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(i.bumpMap=this.bumpMap.toJSON(e).uuid,i.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(i.normalMap=this.normalMap.toJSON(e).uuid,i.normalMapType=this.normalMapType,i.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(i.displacementMap=this.displacementMap.toJSON(e).uuid,i.displacementScale=this.displacementScale,i.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(i.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(i.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(i.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(i.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(i.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(i.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(i.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(i.combine=this.combine)),this.envMapRotation!==void 0&&(i.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(i.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(i.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(i.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(i.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(i.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(i.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(i.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(i.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(i.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(i.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(i.size=this.size),this.sizeAttenuation!==void 0&&(i.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(i.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(i.rotation=this.rotation),this.depthPacking!==void 0&&(i.depthPacking=this.depthPacking),this.linewidth!==void 0&&(i.linewidth=this.linewidth),this.linecap!==void 0&&(i.linecap=this.linecap),this.linejoin!==void 0&&(i.linejoin=this.linejoin),this.dashSize!==void 0&&(i.dashSize=this.dashSize),this.gapSize!==void 0&&(i.gapSize=this.gapSize),this.scale!==void 0&&(i.scale=this.scale),this.wireframe!==void 0&&(i.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(i.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(i.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(i.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(i.flatShading=this.flatShading),this.fog!==void 0&&(i.fog=this.fog),Object.keys(this.userData).length>0&&(i.userData=this.userData);function s(r){let o=[];for(let a in r){let l=r[a];delete l.metadata,o.push(l)}return o}if(t){let r=s(e.textures),o=s(e.images);r.length>0&&(i.textures=r),o.length>0&&(i.images=o)}return i}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new yt().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(i=>new ui().fromJSON(i))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(typeof e.vertexColors=="number"?this.vertexColors=e.vertexColors>0:this.vertexColors=e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let i=e.normalScale;Array.isArray(i)===!1&&(i=[i,i]),this.normalScale=new tt().fromArray(i)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new tt().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,i=null;if(t!==null){let s=t.length;i=new Array(s);for(let r=0;r!==s;++r)i[r]=t[r].clone()}return this.clippingPlanes=i,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(e){e===!0&&this.version++}};var Hs=new V,zf=new V,bc=new V,Sc=new V,Ys=class{constructor(e=new V,t=new V(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,Hs)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let i=t.dot(this.direction);return i<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,i)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=Hs.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(Hs.copy(this.origin).addScaledVector(this.direction,t),Hs.distanceToSquared(e))}distanceSqToSegment(e,t,i,s){zf.copy(e).add(t).multiplyScalar(.5),bc.copy(t).sub(e).normalize(),Sc.copy(this.origin).sub(zf);let r=e.distanceTo(t)*.5,o=-this.direction.dot(bc),a=Sc.dot(this.direction),l=-Sc.dot(bc),c=Sc.lengthSq(),u=Math.abs(1-o*o),h,f,d,g;if(u>0)if(h=o*l-a,f=o*a-l,g=r*u,h>=0)if(f>=-g)if(f<=g){let y=1/u;h*=y,f*=y,d=h*(h+o*f+2*a)+f*(o*h+f+2*l)+c}else f=r,h=Math.max(0,-(o*f+a)),d=-h*h+f*(f+2*l)+c;else f=-r,h=Math.max(0,-(o*f+a)),d=-h*h+f*(f+2*l)+c;else f<=-g?(h=Math.max(0,-(-o*r+a)),f=h>0?-r:Math.min(Math.max(-r,-l),r),d=-h*h+f*(f+2*l)+c):f<=g?(h=0,f=Math.min(Math.max(-r,-l),r),d=f*(f+2*l)+c):(h=Math.max(0,-(o*r+a)),f=h>0?r:Math.min(Math.max(-r,-l),r),d=-h*h+f*(f+2*l)+c);else f=o>0?-r:r,h=Math.max(0,-(o*f+a)),d=-h*h+f*(f+2*l)+c;return i&&i.copy(this.origin).addScaledVector(this.direction,h),s&&s.copy(zf).addScaledVector(bc,f),d}intersectSphere(e,t){if(e.radius<0)return null;Hs.subVectors(e.center,this.origin);let i=Hs.dot(this.direction),s=Hs.dot(Hs)-i*i,r=e.radius*e.radius;if(s>r)return null;let o=Math.sqrt(r-s),a=i-o,l=i+o;return l<0?null:a<0?this.at(l,t):this.at(a,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let i=-(this.origin.dot(e.normal)+e.constant)/t;return i>=0?i:null}intersectPlane(e,t){let i=this.distanceToPlane(e);return i===null?null:this.at(i,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let i,s,r,o,a,l,c=1/this.direction.x,u=1/this.direction.y,h=1/this.direction.z,f=this.origin;return c>=0?(i=(e.min.x-f.x)*c,s=(e.max.x-f.x)*c):(i=(e.max.x-f.x)*c,s=(e.min.x-f.x)*c),u>=0?(r=(e.min.y-f.y)*u,o=(e.max.y-f.y)*u):(r=(e.max.y-f.y)*u,o=(e.min.y-f.y)*u),i>o||r>s||((r>i||isNaN(i))&&(i=r),(o<s||isNaN(s))&&(s=o),h>=0?(a=(e.min.z-f.z)*h,l=(e.max.z-f.z)*h):(a=(e.max.z-f.z)*h,l=(e.min.z-f.z)*h),i>l||a>s)||((a>i||i!==i)&&(i=a),(l<s||s!==s)&&(s=l),s<0)?null:this.at(i>=0?i:s,t)}intersectsBox(e){return this.intersectBox(e,Hs)!==null}intersectTriangle(e,t,i,s,r){let o=this.origin,a=this.direction,l=a.x,c=a.y,u=a.z,h=e.x-o.x,f=e.y-o.y,d=e.z-o.z,g=t.x-o.x,y=t.y-o.y,p=t.z-o.z,m=i.x-o.x,x=i.y-o.y,R=i.z-o.z,S=Math.abs(l),C=Math.abs(c),E=Math.abs(u),v,T,z,N,D,W,G,U,X,K,H,ce;if(S>=C&&S>=E?(z=l,W=h,X=g,ce=m,l>=0?(v=c,T=u,N=f,D=d,G=y,U=p,K=x,H=R):(v=u,T=c,N=d,D=f,G=p,U=y,K=R,H=x)):C>=E?(z=c,W=f,X=y,ce=x,c>=0?(v=u,T=l,N=d,D=h,G=p,U=g,K=R,H=m):(v=l,T=u,N=h,D=d,G=g,U=p,K=m,H=R)):(z=u,W=d,X=p,ce=R,u>=0?(v=l,T=c,N=h,D=f,G=g,U=y,K=m,H=x):(v=c,T=l,N=f,D=h,G=y,U=g,K=x,H=m)),z===0)return null;let J=v/z,Q=T/z,se=1/z,fe=N-J*W,he=D-Q*W,ee=G-J*X,me=U-Q*X,ve=K-J*ce,Ee=H-Q*ce,Se=ve*me-Ee*ee,We=fe*Ee-he*ve,at=ee*he-me*fe;if(s){if(Se<0||We<0||at<0)return null}else if((Se<0||We<0||at<0)&&(Se>0||We>0||at>0))return null;let Ge=Se+We+at;if(Ge===0)return null;let dt=se*(Se*W+We*X+at*ce);return(Ge>0?dt<0:dt>0)?null:this.at(dt/Ge,r)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},ta=class extends qs{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new yt(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new br,this.combine=id,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},lg=new Mt,Yr=new Ys,Mc=new Sr,cg=new V,wc=new V,Tc=new V,Ac=new V,Vf=new V,Ec=new V,ug=new V,Cc=new V,zi=class extends xi{constructor(e=new Gn,t=new ta){super(),this.isMesh=!0,this.type="Mesh",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let t=this.geometry.morphAttributes,i=Object.keys(t);if(i.length>0){let s=t[i[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}getVertexPosition(e,t){let i=this.geometry,s=i.attributes.position,r=i.morphAttributes.position,o=i.morphTargetsRelative;t.fromBufferAttribute(s,e);let a=this.morphTargetInfluences;if(r&&a){Ec.set(0,0,0);for(let l=0,c=r.length;l<c;l++){let u=a[l],h=r[l];u!==0&&(Vf.fromBufferAttribute(h,e),o?Ec.addScaledVector(Vf,u):Ec.addScaledVector(Vf.sub(t),u))}t.add(Ec)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let i=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(i.boundingSphere===null&&i.computeBoundingSphere(),Mc.copy(i.boundingSphere),Mc.applyMatrix4(r),Yr.copy(e.ray).recast(e.near),!(Mc.containsPoint(Yr.origin)===!1&&(Yr.intersectSphere(Mc,cg)===null||Yr.origin.distanceToSquared(cg)>(e.far-e.near)**2))&&(lg.copy(r).invert(),Yr.copy(e.ray).applyMatrix4(lg),!(i.boundingBox!==null&&Yr.intersectsBox(i.boundingBox)===!1)&&this._computeIntersections(e,t,Yr)))}_computeIntersections(e,t,i){let s,r=this.geometry,o=this.material,a=r.index,l=r.attributes.position,c=r.attributes.uv,u=r.attributes.uv1,h=r.attributes.normal,f=r.groups,d=r.drawRange;if(a!==null)if(Array.isArray(o))for(let g=0,y=f.length;g<y;g++){let p=f[g],m=o[p.materialIndex],x=Math.max(p.start,d.start),R=Math.min(a.count,Math.min(p.start+p.count,d.start+d.count));for(let S=x,C=R;S<C;S+=3){let E=a.getX(S),v=a.getX(S+1),T=a.getX(S+2);s=Rc(this,m,e,i,c,u,h,E,v,T),s&&(s.faceIndex=Math.floor(S/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let g=Math.max(0,d.start),y=Math.min(a.count,d.start+d.count);for(let p=g,m=y;p<m;p+=3){let x=a.getX(p),R=a.getX(p+1),S=a.getX(p+2);s=Rc(this,o,e,i,c,u,h,x,R,S),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}else if(l!==void 0)if(Array.isArray(o))for(let g=0,y=f.length;g<y;g++){let p=f[g],m=o[p.materialIndex],x=Math.max(p.start,d.start),R=Math.min(l.count,Math.min(p.start+p.count,d.start+d.count));for(let S=x,C=R;S<C;S+=3){let E=S,v=S+1,T=S+2;s=Rc(this,m,e,i,c,u,h,E,v,T),s&&(s.faceIndex=Math.floor(S/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let g=Math.max(0,d.start),y=Math.min(l.count,d.start+d.count);for(let p=g,m=y;p<m;p+=3){let x=p,R=p+1,S=p+2;s=Rc(this,o,e,i,c,u,h,x,R,S),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}}};function ky(n,e,t,i,s,r,o,a){let l;if(e.side===pi?l=i.intersectTriangle(o,r,s,!0,a):l=i.intersectTriangle(s,r,o,e.side===Cr,a),l===null)return null;Cc.copy(a),Cc.applyMatrix4(n.matrixWorld);let c=t.ray.origin.distanceTo(Cc);return c<t.near||c>t.far?null:{distance:c,point:Cc.clone(),object:n}}function Rc(n,e,t,i,s,r,o,a,l,c){n.getVertexPosition(a,wc),n.getVertexPosition(l,Tc),n.getVertexPosition(c,Ac);let u=ky(n,e,t,i,wc,Tc,Ac,ug);if(u){let h=new V;yr.getBarycoord(ug,wc,Tc,Ac,h),s&&(u.uv=yr.getInterpolatedAttribute(s,a,l,c,h,new tt)),r&&(u.uv1=yr.getInterpolatedAttribute(r,a,l,c,h,new tt)),o&&(u.normal=yr.getInterpolatedAttribute(o,a,l,c,h,new V),u.normal.dot(i.direction)>0&&u.normal.multiplyScalar(-1));let f={a,b:l,c,normal:new V,materialIndex:0};yr.getNormal(wc,Tc,Ac,f.normal),u.face=f,u.barycoord=h}return u}var Qc=class extends vi{constructor(e=null,t=1,i=1,s,r,o,a,l,c=Vn,u=Vn,h,f){super(null,o,a,l,c,u,s,r,h,f),this.isDataTexture=!0,this.image={data:e,width:t,height:i},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var $r=new Sr,zy=new tt(.5,.5),Pc=new V,Kr=class{constructor(e=new ui,t=new ui,i=new ui,s=new ui,r=new ui,o=new ui){this.planes=[e,t,i,s,r,o]}set(e,t,i,s,r,o){let a=this.planes;return a[0].copy(e),a[1].copy(t),a[2].copy(i),a[3].copy(s),a[4].copy(r),a[5].copy(o),this}copy(e){let t=this.planes;for(let i=0;i<6;i++)t[i].copy(e.planes[i]);return this}setFromProjectionMatrix(e,t=ki,i=!1){let s=this.planes,r=e.elements,o=r[0],a=r[1],l=r[2],c=r[3],u=r[4],h=r[5],f=r[6],d=r[7],g=r[8],y=r[9],p=r[10],m=r[11],x=r[12],R=r[13],S=r[14],C=r[15];if(s[0].setComponents(c-o,d-u,m-g,C-x).normalize(),s[1].setComponents(c+o,d+u,m+g,C+x).normalize(),s[2].setComponents(c+a,d+h,m+y,C+R).normalize(),s[3].setComponents(c-a,d-h,m-y,C-R).normalize(),i)s[4].setComponents(l,f,p,S).normalize(),s[5].setComponents(c-l,d-f,m-p,C-S).normalize();else if(s[4].setComponents(c-l,d-f,m-p,C-S).normalize(),t===ki)s[5].setComponents(c+l,d+f,m+p,C+S).normalize();else if(t===tl)s[5].setComponents(l,f,p,S).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),$r.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),$r.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere($r)}intersectsSprite(e){$r.center.set(0,0,0);let t=zy.distanceTo(e.center);return $r.radius=.7071067811865476+t,$r.applyMatrix4(e.matrixWorld),this.intersectsSphere($r)}intersectsSphere(e){let t=this.planes,i=e.center,s=-e.radius;for(let r=0;r<6;r++)if(t[r].distanceToPoint(i)<s)return!1;return!0}intersectsBox(e){let t=this.planes;for(let i=0;i<6;i++){let s=t[i];if(Pc.x=s.normal.x>0?e.max.x:e.min.x,Pc.y=s.normal.y>0?e.max.y:e.min.y,Pc.z=s.normal.z>0?e.max.z:e.min.z,s.distanceToPoint(Pc)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let i=0;i<6;i++)if(t[i].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},hg=new Mt,eu=class n{constructor(){this.coordinateSystem=ki,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,i=this._frustums;for(let s=0;s<t.length;s++){let r=t[s];hg.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),i[s]===void 0&&(i[s]=new Kr),i[s].setFromProjectionMatrix(hg,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,i=e._frustums;for(let s=0;s<e._count;s++)t[s]===void 0&&(t[s]=new Kr),t[s].copy(i[s]);return this._count=e._count,this}clone(){return new n().copy(this)}};var Mr=class extends qs{constructor(e){super(),this.isLineBasicMaterial=!0,this.type="LineBasicMaterial",this.color=new yt(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}},tu=new V,nu=new V,fg=new Mt,Za=new Ys,Ic=new Sr,Gf=new V,dg=new V,iu=class extends xi{constructor(e=new Gn,t=new Mr){super(),this.isLine=!0,this.type="Line",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,i=[0];for(let s=1,r=t.count;s<r;s++)tu.fromBufferAttribute(t,s-1),nu.fromBufferAttribute(t,s),i[s]=i[s-1],i[s]+=tu.distanceTo(nu);e.setAttribute("lineDistance",new qn(i,1))}else Ye("Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let i=this.geometry,s=this.matrixWorld,r=e.params.Line.threshold,o=i.drawRange;if(i.boundingSphere===null&&i.computeBoundingSphere(),Ic.copy(i.boundingSphere),Ic.applyMatrix4(s),Ic.radius+=r,e.ray.intersectsSphere(Ic)===!1)return;fg.copy(s).invert(),Za.copy(e.ray).applyMatrix4(fg);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=this.isLineSegments?2:1,u=i.index,f=i.attributes.position;if(u!==null){let d=Math.max(0,o.start),g=Math.min(u.count,o.start+o.count);for(let y=d,p=g-1;y<p;y+=c){let m=u.getX(y),x=u.getX(y+1),R=Lc(this,e,Za,l,m,x,y);R&&t.push(R)}if(this.isLineLoop){let y=u.getX(g-1),p=u.getX(d),m=Lc(this,e,Za,l,y,p,g-1);m&&t.push(m)}}else{let d=Math.max(0,o.start),g=Math.min(f.count,o.start+o.count);for(let y=d,p=g-1;y<p;y+=c){let m=Lc(this,e,Za,l,y,y+1,y);m&&t.push(m)}if(this.isLineLoop){let y=Lc(this,e,Za,l,g-1,d,g-1);y&&t.push(y)}}}updateMorphTargets(){let t=this.geometry.morphAttributes,i=Object.keys(t);if(i.length>0){let s=t[i[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function Lc(n,e,t,i,s,r,o){let a=n.geometry.attributes.position;if(tu.fromBufferAttribute(a,s),nu.fromBufferAttribute(a,r),t.distanceSqToSegment(tu,nu,Gf,dg)>i)return;Gf.applyMatrix4(n.matrixWorld);let c=e.ray.origin.distanceTo(Gf);if(!(c<e.near||c>e.far))return{distance:c,point:dg.clone().applyMatrix4(n.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:n}}var pg=new V,mg=new V,wr=class extends iu{constructor(e,t){super(e,t),this.isLineSegments=!0,this.type="LineSegments"}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,i=[];for(let s=0,r=t.count;s<r;s+=2)pg.fromBufferAttribute(t,s),mg.fromBufferAttribute(t,s+1),i[s]=s===0?0:i[s-1],i[s+1]=i[s]+pg.distanceTo(mg);e.setAttribute("lineDistance",new qn(i,1))}else Ye("LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}};var na=class extends qs{constructor(e){super(),this.isPointsMaterial=!0,this.type="PointsMaterial",this.color=new yt(16777215),this.map=null,this.alphaMap=null,this.size=1,this.sizeAttenuation=!0,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.alphaMap=e.alphaMap,this.size=e.size,this.sizeAttenuation=e.sizeAttenuation,this.fog=e.fog,this}},gg=new Mt,Yf=new Ys,Dc=new Sr,Nc=new V,$s=class extends xi{constructor(e=new Gn,t=new na){super(),this.isPoints=!0,this.type="Points",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let i=this.geometry,s=this.matrixWorld,r=e.params.Points.threshold,o=i.drawRange;if(i.boundingSphere===null&&i.computeBoundingSphere(),Dc.copy(i.boundingSphere),Dc.applyMatrix4(s),Dc.radius+=r,e.ray.intersectsSphere(Dc)===!1)return;gg.copy(s).invert(),Yf.copy(e.ray).applyMatrix4(gg);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=i.index,h=i.attributes.position;if(c!==null){let f=Math.max(0,o.start),d=Math.min(c.count,o.start+o.count);for(let g=f,y=d;g<y;g++){let p=c.getX(g);Nc.fromBufferAttribute(h,p),_g(Nc,p,l,s,e,t,this)}}else{let f=Math.max(0,o.start),d=Math.min(h.count,o.start+o.count);for(let g=f,y=d;g<y;g++)Nc.fromBufferAttribute(h,g),_g(Nc,g,l,s,e,t,this)}}updateMorphTargets(){let t=this.geometry.morphAttributes,i=Object.keys(t);if(i.length>0){let s=t[i[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function _g(n,e,t,i,s,r,o){let a=Yf.distanceSqToPoint(n);if(a<t){let l=new V;Yf.closestPointToPoint(n,l),l.applyMatrix4(i);let c=s.ray.origin.distanceTo(l);if(c<s.near||c>s.far)return;r.push({distance:c,distanceToRay:Math.sqrt(a),point:l,index:e,face:null,faceIndex:null,barycoord:null,object:o})}}var al=class extends vi{constructor(e=[],t=Qr,i,s,r,o,a,l,c,u){super(e,t,i,s,r,o,a,l,c,u),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}};var Zs=class extends vi{constructor(e,t,i=is,s,r,o,a=Vn,l=Vn,c,u=Xs,h=1){if(u!==Xs&&u!==Js)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let f={width:e,height:t,depth:h};super(f,s,r,o,a,l,u,i,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new jo(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},ll=class extends Zs{constructor(e,t=is,i=Qr,s,r,o=Vn,a=Vn,l,c=Xs){let u={width:e,height:e,depth:1},h=[u,u,u,u,u,u];super(e,e,t,i,s,r,o,a,l,c),this.image=h,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},cl=class extends vi{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},ia=class n extends Gn{constructor(e=1,t=1,i=1,s=1,r=1,o=1){super(),this.type="BoxGeometry",this.parameters={width:e,height:t,depth:i,widthSegments:s,heightSegments:r,depthSegments:o};let a=this;s=Math.floor(s),r=Math.floor(r),o=Math.floor(o);let l=[],c=[],u=[],h=[],f=0,d=0;g("z","y","x",-1,-1,i,t,e,o,r,0),g("z","y","x",1,-1,i,t,-e,o,r,1),g("x","z","y",1,1,e,i,t,s,o,2),g("x","z","y",1,-1,e,i,-t,s,o,3),g("x","y","z",1,-1,e,t,i,s,r,4),g("x","y","z",-1,-1,e,t,-i,s,r,5),this.setIndex(l),this.setAttribute("position",new qn(c,3)),this.setAttribute("normal",new qn(u,3)),this.setAttribute("uv",new qn(h,2));function g(y,p,m,x,R,S,C,E,v,T,z){let N=S/v,D=C/T,W=S/2,G=C/2,U=E/2,X=v+1,K=T+1,H=0,ce=0,J=new V;for(let Q=0;Q<K;Q++){let se=Q*D-G;for(let fe=0;fe<X;fe++){let he=fe*N-W;J[y]=he*x,J[p]=se*R,J[m]=U,c.push(J.x,J.y,J.z),J[y]=0,J[p]=0,J[m]=E>0?1:-1,u.push(J.x,J.y,J.z),h.push(fe/v),h.push(1-Q/T),H+=1}}for(let Q=0;Q<T;Q++)for(let se=0;se<v;se++){let fe=f+se+X*Q,he=f+se+X*(Q+1),ee=f+(se+1)+X*(Q+1),me=f+(se+1)+X*Q;l.push(fe,he,me),l.push(he,ee,me),ce+=6}a.addGroup(d,ce,z),d+=ce,f+=H}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new n(e.width,e.height,e.depth,e.widthSegments,e.heightSegments,e.depthSegments)}};var ul=class n extends Gn{constructor(e=1,t=1,i=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:e,height:t,widthSegments:i,heightSegments:s};let r=e/2,o=t/2,a=Math.floor(i),l=Math.floor(s),c=a+1,u=l+1,h=e/a,f=t/l,d=[],g=[],y=[],p=[];for(let m=0;m<u;m++){let x=m*f-o;for(let R=0;R<c;R++){let S=R*h-r;g.push(S,-x,0),y.push(0,0,1),p.push(R/a),p.push(1-m/l)}}for(let m=0;m<l;m++)for(let x=0;x<a;x++){let R=x+c*m,S=x+c*(m+1),C=x+1+c*(m+1),E=x+1+c*m;d.push(R,S,E),d.push(S,C,E)}this.setIndex(d),this.setAttribute("position",new qn(g,3)),this.setAttribute("normal",new qn(y,3)),this.setAttribute("uv",new qn(p,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new n(e.width,e.height,e.widthSegments,e.heightSegments)}};var hl=class n extends Gn{constructor(e=1,t=32,i=16,s=0,r=Math.PI*2,o=0,a=Math.PI){super(),this.type="SphereGeometry",this.parameters={radius:e,widthSegments:t,heightSegments:i,phiStart:s,phiLength:r,thetaStart:o,thetaLength:a},t=Math.max(3,Math.floor(t)),i=Math.max(2,Math.floor(i));let l=Math.min(o+a,Math.PI),c=0,u=[],h=new V,f=new V,d=[],g=[],y=[],p=[];for(let m=0;m<=i;m++){let x=[],R=m/i,S=o+R*a,C=e*Math.cos(S),E=Math.sqrt(e*e-C*C),v=0;m===0&&o===0?v=.5/t:m===i&&l===Math.PI&&(v=-.5/t);for(let T=0;T<=t;T++){let z=T/t,N=s+z*r;h.x=-E*Math.cos(N),h.y=C,h.z=E*Math.sin(N),g.push(h.x,h.y,h.z),f.copy(h).normalize(),y.push(f.x,f.y,f.z),p.push(z+v,1-R),x.push(c++)}u.push(x)}for(let m=0;m<i;m++)for(let x=0;x<t;x++){let R=u[m][x+1],S=u[m][x],C=u[m+1][x],E=u[m+1][x+1];(m!==0||o>0)&&d.push(R,S,E),(m!==i-1||l<Math.PI)&&d.push(S,C,E)}this.setIndex(d),this.setAttribute("position",new qn(g,3)),this.setAttribute("normal",new qn(y,3)),this.setAttribute("uv",new qn(p,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new n(e.radius,e.widthSegments,e.heightSegments,e.phiStart,e.phiLength,e.thetaStart,e.thetaLength)}};function to(n){let e={};for(let t in n){e[t]={};for(let i in n[t]){let s=n[t][i];if(vg(s))s.isRenderTargetTexture?(Ye("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),e[t][i]=null):e[t][i]=s.clone();else if(Array.isArray(s))if(vg(s[0])){let r=[];for(let o=0,a=s.length;o<a;o++)r[o]=s[o].clone();e[t][i]=r}else e[t][i]=s.slice();else e[t][i]=s}}return e}function ei(n){let e={};for(let t=0;t<n.length;t++){let i=to(n[t]);for(let s in i)e[s]=i[s]}return e}function vg(n){return n&&(n.isColor||n.isMatrix3||n.isMatrix4||n.isVector2||n.isVector3||n.isVector4||n.isTexture||n.isQuaternion)}function Vy(n){let e=[];for(let t=0;t<n.length;t++)e.push(n[t].clone());return e}function Rd(n){let e=n.getRenderTarget();return e===null?n.outputColorSpace:e.isXRRenderTarget===!0?e.texture.colorSpace:_t.workingColorSpace}var h_={clone:to,merge:ei},Gy=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Hy=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,Vi=class extends qs{constructor(e){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Gy,this.fragmentShader=Hy,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=to(e.uniforms),this.uniformsGroups=Vy(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let s in this.uniforms){let o=this.uniforms[s].value;o&&o.isTexture?t.uniforms[s]={type:"t",value:o.toJSON(e).uuid}:o&&o.isColor?t.uniforms[s]={type:"c",value:o.getHex()}:o&&o.isVector2?t.uniforms[s]={type:"v2",value:o.toArray()}:o&&o.isVector3?t.uniforms[s]={type:"v3",value:o.toArray()}:o&&o.isVector4?t.uniforms[s]={type:"v4",value:o.toArray()}:o&&o.isMatrix3?t.uniforms[s]={type:"m3",value:o.toArray()}:o&&o.isMatrix4?t.uniforms[s]={type:"m4",value:o.toArray()}:t.uniforms[s]={value:o}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let i={};for(let s in this.extensions)this.extensions[s]===!0&&(i[s]=!0);return Object.keys(i).length>0&&(t.extensions=i),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let i in e.uniforms){let s=e.uniforms[i];switch(this.uniforms[i]={},s.type){case"t":this.uniforms[i].value=t[s.value]||null;break;case"c":this.uniforms[i].value=new yt().setHex(s.value);break;case"v2":this.uniforms[i].value=new tt().fromArray(s.value);break;case"v3":this.uniforms[i].value=new V().fromArray(s.value);break;case"v4":this.uniforms[i].value=new rn().fromArray(s.value);break;case"m3":this.uniforms[i].value=new nt().fromArray(s.value);break;case"m4":this.uniforms[i].value=new Mt().fromArray(s.value);break;default:this.uniforms[i].value=s.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let i in e.extensions)this.extensions[i]=e.extensions[i];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},su=class extends Vi{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}};var ru=class extends qs{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=Zg,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},ou=class extends qs{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function Xo(n,e){return!n||n.constructor===e?n:typeof e.BYTES_PER_ELEMENT=="number"?new e(n):Array.prototype.slice.call(n)}function Uc(n){return n!==void 0&&n.inTangents!==void 0&&n.outTangents!==void 0}var Tr=class{constructor(e,t,i,s){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new t.constructor(i),this.sampleValues=t,this.valueSize=i,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,i=this._cachedIndex,s=t[i],r=t[i-1];e:{t:{let o;n:{i:if(!(e<s)){for(let a=i+2;;){if(s===void 0){if(e<r)break i;return i=t.length,this._cachedIndex=i,this.copySampleValue_(i-1)}if(i===a)break;if(r=s,s=t[++i],e<s)break t}o=t.length;break n}if(!(e>=r)){let a=t[1];e<a&&(i=2,r=a);for(let l=i-2;;){if(r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(i===l)break;if(s=r,r=t[--i-1],e>=r)break t}o=i,i=0;break n}break e}for(;i<o;){let a=i+o>>>1;e<t[a]?o=a:i=a+1}if(s=t[i],r=t[i-1],r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return i=t.length,this._cachedIndex=i,this.copySampleValue_(i-1)}this._cachedIndex=i,this.intervalChanged_(i,r,s)}return this.interpolate_(i,r,e,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,i=this.sampleValues,s=this.valueSize,r=e*s;for(let o=0;o!==s;++o)t[o]=i[r+o];return t}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},au=class extends Tr{constructor(e,t,i,s){super(e,t,i,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:Wf,endingEnd:Wf}}intervalChanged_(e,t,i){let s=this.parameterPositions,r=e-2,o=e+1,a=s[r],l=s[o];if(a===void 0)switch(this.getSettings_().endingStart){case Xf:r=e,a=2*t-i;break;case qf:r=s.length-2,a=t+s[r]-s[r+1];break;default:r=e,a=i}if(l===void 0)switch(this.getSettings_().endingEnd){case Xf:o=e,l=2*i-t;break;case qf:o=1,l=i+s[1]-s[0];break;default:o=e-1,l=t}let c=(i-t)*.5,u=this.valueSize;this._weightPrev=c/(t-a),this._weightNext=c/(l-i),this._offsetPrev=r*u,this._offsetNext=o*u}interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,u=this._offsetPrev,h=this._offsetNext,f=this._weightPrev,d=this._weightNext,g=(i-t)/(s-t),y=g*g,p=y*g,m=-f*p+2*f*y-f*g,x=(1+f)*p+(-1.5-2*f)*y+(-.5+f)*g+1,R=(-1-d)*p+(1.5+d)*y+.5*g,S=d*p-d*y;for(let C=0;C!==a;++C)r[C]=m*o[u+C]+x*o[c+C]+R*o[l+C]+S*o[h+C];return r}},lu=class extends Tr{constructor(e,t,i,s){super(e,t,i,s)}interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,u=(i-t)/(s-t),h=1-u;for(let f=0;f!==a;++f)r[f]=o[c+f]*h+o[l+f]*u;return r}},cu=class extends Tr{constructor(e,t,i,s){super(e,t,i,s)}interpolate_(e){return this.copySampleValue_(e-1)}},uu=class extends Tr{interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,u=this.inTangents,h=this.outTangents;if(!u||!h){let g=(i-t)/(s-t),y=1-g;for(let p=0;p!==a;++p)r[p]=o[c+p]*y+o[l+p]*g;return r}let f=a*2,d=e-1;for(let g=0;g!==a;++g){let y=o[c+g],p=o[l+g],m=d*f+g*2,x=h[m],R=h[m+1],S=e*f+g*2,C=u[S],E=u[S+1],v=Xy(i,t,x,C,s);r[g]=f_(v,y,R,E,p)}return r}};function f_(n,e,t,i,s){let r=1-n;return r*r*r*e+3*r*r*n*t+3*r*n*n*i+n*n*n*s}function Wy(n,e,t,i,s){let r=1-n;return 3*r*r*(t-e)+6*r*n*(i-t)+3*n*n*(s-i)}function Xy(n,e,t,i,s){let r=(n-e)/(s-e);for(let o=0;o<8;o++){let a=f_(r,e,t,i,s)-n;if(Math.abs(a)<1e-10)break;let l=Wy(r,e,t,i,s);if(Math.abs(l)<1e-10)break;r=Math.max(0,Math.min(1,r-a/l))}return r}var Pi=class{constructor(e,t,i,s){if(e===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(t===void 0||t.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+e);this.name=e,this.times=Xo(t,this.TimeBufferType),this.values=Xo(i,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,i;if(t.toJSON!==this.toJSON)i=t.toJSON(e);else{i={name:e.name,times:Xo(e.times,Array),values:Xo(e.values,Array)};let s=e.getInterpolation();s!==e.DefaultInterpolation&&(i.interpolation=s),Uc(e.settings)&&(i.settings={inTangents:Xo(e.settings.inTangents,Array),outTangents:Xo(e.settings.outTangents,Array)})}return i.type=e.ValueTypeName,i}InterpolantFactoryMethodDiscrete(e){return new cu(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new lu(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new au(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new uu(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case Qa:t=this.InterpolantFactoryMethodDiscrete;break;case Zc:t=this.InterpolantFactoryMethodLinear;break;case Bc:t=this.InterpolantFactoryMethodSmooth;break;case Hf:t=this.InterpolantFactoryMethodBezier;break}if(t===void 0){let i="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(i);return Ye("KeyframeTrack:",i),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return Qa;case this.InterpolantFactoryMethodLinear:return Zc;case this.InterpolantFactoryMethodSmooth:return Bc;case this.InterpolantFactoryMethodBezier:return Hf}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let i=0,s=t.length;i!==s;++i)t[i]+=e;Uc(this.settings)&&(xg(this.settings.inTangents,e),xg(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let i=0,s=t.length;i!==s;++i)t[i]*=e;Uc(this.settings)&&(yg(this.settings.inTangents,e),yg(this.settings.outTangents,e))}return this}trim(e,t){let i=this.times,s=i.length,r=0,o=s-1;for(;r!==s&&i[r]<e;)++r;for(;o!==-1&&i[o]>t;)--o;if(++o,r!==0||o!==s){r>=o&&(o=Math.max(o,1),r=o-1);let a=this.getValueSize();this.times=i.slice(r,o),this.values=this.values.slice(r*a,o*a)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(Qe("KeyframeTrack: Invalid value size in track.",this),e=!1);let i=this.times,s=this.values,r=i.length;r===0&&(Qe("KeyframeTrack: Track is empty.",this),e=!1);let o=null;for(let a=0;a!==r;a++){let l=i[a];if(typeof l=="number"&&isNaN(l)){Qe("KeyframeTrack: Time is not a valid number.",this,a,l),e=!1;break}if(o!==null&&o>l){Qe("KeyframeTrack: Out of order keys.",this,a,l,o),e=!1;break}o=l}if(s!==void 0&&ay(s))for(let a=0,l=s.length;a!==l;++a){let c=s[a];if(isNaN(c)){Qe("KeyframeTrack: Value is not a valid number.",this,a,c),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),i=this.getValueSize(),s=this.getInterpolation()===Bc,r=e.length-1,o=1;for(let a=1;a<r;++a){let l=!1,c=e[a],u=e[a+1];if(c!==u&&(a!==1||c!==e[0]))if(s)l=!0;else{let h=a*i,f=h-i,d=h+i;for(let g=0;g!==i;++g){let y=t[h+g];if(y!==t[f+g]||y!==t[d+g]){l=!0;break}}}if(l){if(a!==o){e[o]=e[a];let h=a*i,f=o*i;for(let d=0;d!==i;++d)t[f+d]=t[h+d]}++o}}if(r>0){e[o]=e[r];for(let a=r*i,l=o*i,c=0;c!==i;++c)t[l+c]=t[a+c];++o}return o!==e.length?(this.times=e.slice(0,o),this.values=t.slice(0,o*i)):(this.times=e,this.values=t),this}clone(){let e=this.times.slice(),t=this.values.slice(),i=this.constructor,s=new i(this.name,e,t);return s.createInterpolant=this.createInterpolant,Uc(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function xg(n,e){for(let t=0,i=n.length;t!==i;t+=2)n[t]+=e}function yg(n,e){for(let t=0,i=n.length;t!==i;t+=2)n[t]*=e}Pi.prototype.ValueTypeName="";Pi.prototype.TimeBufferType=Float32Array;Pi.prototype.ValueBufferType=Float32Array;Pi.prototype.DefaultInterpolation=Zc;var Ar=class extends Pi{constructor(e,t,i){super(e,t,i)}};Ar.prototype.ValueTypeName="bool";Ar.prototype.ValueBufferType=Array;Ar.prototype.DefaultInterpolation=Qa;Ar.prototype.InterpolantFactoryMethodLinear=void 0;Ar.prototype.InterpolantFactoryMethodSmooth=void 0;var hu=class extends Pi{constructor(e,t,i,s){super(e,t,i,s)}};hu.prototype.ValueTypeName="color";var fu=class extends Pi{constructor(e,t,i,s){super(e,t,i,s)}};fu.prototype.ValueTypeName="number";var du=class extends Tr{constructor(e,t,i,s){super(e,t,i,s)}interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=(i-t)/(s-t),c=e*a;for(let u=c+a;c!==u;c+=4)di.slerpFlat(r,0,o,c-a,o,c,l);return r}},fl=class extends Pi{constructor(e,t,i,s){super(e,t,i,s)}InterpolantFactoryMethodLinear(e){return new du(this.times,this.values,this.getValueSize(),e)}};fl.prototype.ValueTypeName="quaternion";fl.prototype.InterpolantFactoryMethodSmooth=void 0;var Er=class extends Pi{constructor(e,t,i){super(e,t,i)}};Er.prototype.ValueTypeName="string";Er.prototype.ValueBufferType=Array;Er.prototype.DefaultInterpolation=Qa;Er.prototype.InterpolantFactoryMethodLinear=void 0;Er.prototype.InterpolantFactoryMethodSmooth=void 0;var pu=class extends Pi{constructor(e,t,i,s){super(e,t,i,s)}};pu.prototype.ValueTypeName="vector";var mu=class{constructor(e,t,i){let s=this,r=!1,o=0,a=0,l,c=[];this.onStart=void 0,this.onLoad=e,this.onProgress=t,this.onError=i,this._abortController=null,this.itemStart=function(u){a++,r===!1&&s.onStart!==void 0&&s.onStart(u,o,a),r=!0},this.itemEnd=function(u){o++,s.onProgress!==void 0&&s.onProgress(u,o,a),o===a&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(u){s.onError!==void 0&&s.onError(u)},this.resolveURL=function(u){return u=u.normalize("NFC"),l?l(u):u},this.setURLModifier=function(u){return l=u,this},this.addHandler=function(u,h){return c.push(u,h),this},this.removeHandler=function(u){let h=c.indexOf(u);return h!==-1&&c.splice(h,2),this},this.getHandler=function(u){for(let h=0,f=c.length;h<f;h+=2){let d=c[h],g=c[h+1];if(d.global&&(d.lastIndex=0),d.test(u))return g}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||(this._abortController=new AbortController),this._abortController}},d_=new mu,gu=class{constructor(e){this.manager=e!==void 0?e:d_,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default",typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}load(){}loadAsync(e,t){let i=this;return new Promise(function(s,r){i.load(e,s,t,r)})}parse(){}setCrossOrigin(e){return this.crossOrigin=e,this}setWithCredentials(e){return this.withCredentials=e,this}setPath(e){return this.path=e,this}setResourcePath(e){return this.resourcePath=e,this}setRequestHeader(e){return this.requestHeader=e,this}setPriority(e){return this.priority=e,this}setCache(e){return this.cache=e,this}abort(){return this}};gu.DEFAULT_MATERIAL_NAME="__DEFAULT";var Oc=new V,Fc=new di,bs=new V,dl=class extends xi{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new Mt,this.projectionMatrix=new Mt,this.projectionMatrixInverse=new Mt,this.coordinateSystem=ki,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(Oc,Fc,bs),bs.x===1&&bs.y===1&&bs.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Oc,Fc,bs.set(1,1,1)).invert()}updateWorldMatrix(e,t,i=!1){super.updateWorldMatrix(e,t,i),this.matrixWorld.decompose(Oc,Fc,bs),bs.x===1&&bs.y===1&&bs.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Oc,Fc,bs.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},xr=new V,bg=new tt,Sg=new tt,hi=class extends dl{constructor(e=50,t=1,i=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=e,this.zoom=1,this.near=i,this.far=s,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=Jo*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(Ja*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return Jo*2*Math.atan(Math.tan(Ja*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,i){xr.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(xr.x,xr.y).multiplyScalar(-e/xr.z),xr.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),i.set(xr.x,xr.y).multiplyScalar(-e/xr.z)}getViewSize(e,t){return this.getViewBounds(e,bg,Sg),t.subVectors(Sg,bg)}setViewOffset(e,t,i,s,r,o){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=i,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(Ja*.5*this.fov)/this.zoom,i=2*t,s=this.aspect*i,r=-.5*s,o=this.view;if(this.view!==null&&this.view.enabled){let l=o.fullWidth,c=o.fullHeight;r+=o.offsetX*s/l,t-=o.offsetY*i/c,s*=o.width/l,i*=o.height/c}let a=this.filmOffset;a!==0&&(r+=e*a/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,t,t-i,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}};var sa=class extends dl{constructor(e=-1,t=1,i=1,s=-1,r=.1,o=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=i,this.bottom=s,this.near=r,this.far=o,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,i,s,r,o){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=i,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),i=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=i-e,o=i+e,a=s+t,l=s-t;if(this.view!==null&&this.view.enabled){let c=(this.right-this.left)/this.view.fullWidth/this.zoom,u=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,o=r+c*this.view.width,a-=u*this.view.offsetY,l=a-u*this.view.height}this.projectionMatrix.makeOrthographic(r,o,a,l,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}};var qo=-90,Yo=1,ra=class extends xi{constructor(e,t,i){super(),this.type="CubeCamera",this.renderTarget=i,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new hi(qo,Yo,e,t);s.layers=this.layers,this.add(s);let r=new hi(qo,Yo,e,t);r.layers=this.layers,this.add(r);let o=new hi(qo,Yo,e,t);o.layers=this.layers,this.add(o);let a=new hi(qo,Yo,e,t);a.layers=this.layers,this.add(a);let l=new hi(qo,Yo,e,t);l.layers=this.layers,this.add(l);let c=new hi(qo,Yo,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[i,s,r,o,a,l]=t;for(let c of t)this.remove(c);if(e===ki)i.up.set(0,1,0),i.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),o.up.set(0,0,1),o.lookAt(0,-1,0),a.up.set(0,1,0),a.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(e===tl)i.up.set(0,-1,0),i.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),o.up.set(0,0,-1),o.lookAt(0,-1,0),a.up.set(0,-1,0),a.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+e);for(let c of t)this.add(c),c.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:i,activeMipmapLevel:s}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[r,o,a,l,c,u]=this.children,h=e.getRenderTarget(),f=e.getActiveCubeFace(),d=e.getActiveMipmapLevel(),g=e.xr.enabled;e.xr.enabled=!1;let y=i.texture.mipmapsAutoUpdate;i.texture.mipmapsAutoUpdate=!1;let p=!1;e.isWebGLRenderer===!0?p=e.state.buffers.depth.getReversed():p=e.reversedDepthBuffer,e.setRenderTarget(i,0,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,r),e.setRenderTarget(i,1,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(i,2,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(i,3,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(i,4,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),i.texture.mipmapsAutoUpdate=y,e.setRenderTarget(i,5,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,u),e.setRenderTarget(h,f,d),e.xr.enabled=g,i.texture.needsPMREMUpdate=!0}},_u=class extends hi{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}};var Pd="\\[\\]\\.:\\/",qy=new RegExp("["+Pd+"]","g"),Id="[^"+Pd+"]",Yy="[^"+Pd.replace("\\.","")+"]",$y=/((?:WC+[\/:])*)/.source.replace("WC",Id),Zy=/(WCOD+)?/.source.replace("WCOD",Yy),Ky=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",Id),Jy=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",Id),jy=new RegExp("^"+$y+Zy+Ky+Jy+"$"),Qy=["material","materials","bones","map"],$f=class{constructor(e,t,i){let s=i||Jt.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,s)}getValue(e,t){this.bind();let i=this._targetGroup.nCachedObjects_,s=this._bindings[i];s!==void 0&&s.getValue(e,t)}setValue(e,t){let i=this._bindings;for(let s=this._targetGroup.nCachedObjects_,r=i.length;s!==r;++s)i[s].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,i=e.length;t!==i;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,i=e.length;t!==i;++t)e[t].unbind()}},Jt=class n{constructor(e,t,i){this.path=t,this.parsedPath=i||n.parseTrackName(t),this.node=n.findNode(e,this.parsedPath.nodeName),this.rootNode=e,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(e,t,i){return e&&e.isAnimationObjectGroup?new n.Composite(e,t,i):new n(e,t,i)}static sanitizeNodeName(e){return e.replace(/\s/g,"_").replace(qy,"")}static parseTrackName(e){let t=jy.exec(e);if(t===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+e);let i={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},s=i.nodeName&&i.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=i.nodeName.substring(s+1);Qy.indexOf(r)!==-1&&(i.nodeName=i.nodeName.substring(0,s),i.objectName=r)}if(i.propertyName===null||i.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+e);return i}static findNode(e,t){if(t===void 0||t===""||t==="."||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let i=e.skeleton.getBoneByName(t);if(i!==void 0)return i}if(e.children){let i=function(r){for(let o=0;o<r.length;o++){let a=r[o];if(a.name===t||a.uuid===t)return a;let l=i(a.children);if(l)return l}return null},s=i(e.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)e[t++]=i[s]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)i[s]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)i[s]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)i[s]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let e=this.node,t=this.parsedPath,i=t.objectName,s=t.propertyName,r=t.propertyIndex;if(e||(e=n.findNode(this.rootNode,t.nodeName),this.node=e),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!e){Ye("PropertyBinding: No target node found for track: "+this.path+".");return}if(i){let c=t.objectIndex;switch(i){case"materials":if(!e.material){Qe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.materials){Qe("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}e=e.material.materials;break;case"bones":if(!e.skeleton){Qe("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}e=e.skeleton.bones;for(let u=0;u<e.length;u++)if(e[u].name===c){c=u;break}break;case"map":if("map"in e){e=e.map;break}if(!e.material){Qe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.map){Qe("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}e=e.material.map;break;default:if(e[i]===void 0){Qe("PropertyBinding: Can not bind to objectName of node undefined.",this);return}e=e[i]}if(c!==void 0){if(e[c]===void 0){Qe("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,e);return}e=e[c]}}let o=e[s];if(o===void 0){let c=t.nodeName;Qe("PropertyBinding: Trying to update property for track: "+c+"."+s+" but it wasn't found.",e);return}let a=this.Versioning.None;this.targetObject=e,e.isMaterial===!0?a=this.Versioning.NeedsUpdate:e.isObject3D===!0&&(a=this.Versioning.MatrixWorldNeedsUpdate);let l=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!e.geometry){Qe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!e.geometry.morphAttributes){Qe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}e.morphTargetDictionary[r]!==void 0&&(r=e.morphTargetDictionary[r])}l=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=r}else o.fromArray!==void 0&&o.toArray!==void 0?(l=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(l=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=s;this.getValue=this.GetterByBindingType[l],this.setValue=this.SetterByBindingTypeAndVersioning[l][a]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};Jt.Composite=$f;Jt.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};Jt.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};Jt.prototype.GetterByBindingType=[Jt.prototype._getValue_direct,Jt.prototype._getValue_array,Jt.prototype._getValue_arrayElement,Jt.prototype._getValue_toArray];Jt.prototype.SetterByBindingTypeAndVersioning=[[Jt.prototype._setValue_direct,Jt.prototype._setValue_direct_setNeedsUpdate,Jt.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[Jt.prototype._setValue_array,Jt.prototype._setValue_array_setNeedsUpdate,Jt.prototype._setValue_array_setMatrixWorldNeedsUpdate],[Jt.prototype._setValue_arrayElement,Jt.prototype._setValue_arrayElement_setNeedsUpdate,Jt.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[Jt.prototype._setValue_fromArray,Jt.prototype._setValue_fromArray_setNeedsUpdate,Jt.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var wC=new Float32Array(1);var Mg=new Mt,pl=class{constructor(e,t,i=0,s=1/0){this.ray=new Ys(e,t),this.near=i,this.far=s,this.camera=null,this.layers=new Qo,this.params={Mesh:{},Line:{threshold:1},LOD:{},Points:{threshold:1},Sprite:{}}}set(e,t){this.ray.set(e,t)}setFromCamera(e,t){t.isPerspectiveCamera?(this.ray.origin.setFromMatrixPosition(t.matrixWorld),this.ray.direction.set(e.x,e.y,.5).unproject(t).sub(this.ray.origin).normalize(),this.camera=t):t.isOrthographicCamera?(this.ray.origin.set(e.x,e.y,t.projectionMatrix.elements[14]).unproject(t),this.ray.direction.set(0,0,-1).transformDirection(t.matrixWorld),this.camera=t):Qe("Raycaster: Unsupported camera type: "+t.type)}setFromXRController(e){return Mg.identity().extractRotation(e.matrixWorld),this.ray.origin.setFromMatrixPosition(e.matrixWorld),this.ray.direction.set(0,0,-1).applyMatrix4(Mg),this}intersectObject(e,t=!0,i=[]){return Zf(e,this,i,t),i.sort(wg),i}intersectObjects(e,t=!0,i=[]){for(let s=0,r=e.length;s<r;s++)Zf(e[s],this,i,t);return i.sort(wg),i}};function wg(n,e){return n.distance-e.distance}function Zf(n,e,t,i){let s=!0;if(n.layers.test(e.layers)&&n.raycast(e,t)===!1&&(s=!1),s===!0&&i===!0){let r=n.children;for(let o=0,a=r.length;o<a;o++)Zf(r[o],e,t,!0)}}var oa=class{constructor(e=1,t=0,i=0){this.radius=e,this.phi=t,this.theta=i}set(e,t,i){return this.radius=e,this.phi=t,this.theta=i,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){return this.phi=vt(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,i){return this.radius=Math.sqrt(e*e+t*t+i*i),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,i),this.phi=Math.acos(vt(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var Kf=class{static{this.prototype.isMatrix2=!0}constructor(e,t,i,s){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,i,s)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let i=0;i<4;i++)this.elements[i]=e[i+t];return this}set(e,t,i,s){let r=this.elements;return r[0]=e,r[2]=t,r[1]=i,r[3]=s,this}};var ml=class extends es{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function Ld(n,e,t,i){let s=eb(i);switch(t){case gd:return n*e;case vd:return n*e/s.components*s.byteLength;case wu:return n*e/s.components*s.byteLength;case Rr:return n*e*2/s.components*s.byteLength;case Tu:return n*e*2/s.components*s.byteLength;case _d:return n*e*3/s.components*s.byteLength;case os:return n*e*4/s.components*s.byteLength;case Au:return n*e*4/s.components*s.byteLength;case vl:case xl:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*8;case yl:case bl:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*16;case Cu:case Pu:return Math.max(n,16)*Math.max(e,8)/4;case Eu:case Ru:return Math.max(n,8)*Math.max(e,8)/2;case Iu:case Lu:case Nu:case Uu:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*8;case Du:case Sl:case Ou:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*16;case Fu:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*16;case Bu:return Math.floor((n+4)/5)*Math.floor((e+3)/4)*16;case ku:return Math.floor((n+4)/5)*Math.floor((e+4)/5)*16;case zu:return Math.floor((n+5)/6)*Math.floor((e+4)/5)*16;case Vu:return Math.floor((n+5)/6)*Math.floor((e+5)/6)*16;case Gu:return Math.floor((n+7)/8)*Math.floor((e+4)/5)*16;case Hu:return Math.floor((n+7)/8)*Math.floor((e+5)/6)*16;case Wu:return Math.floor((n+7)/8)*Math.floor((e+7)/8)*16;case Xu:return Math.floor((n+9)/10)*Math.floor((e+4)/5)*16;case qu:return Math.floor((n+9)/10)*Math.floor((e+5)/6)*16;case Yu:return Math.floor((n+9)/10)*Math.floor((e+7)/8)*16;case $u:return Math.floor((n+9)/10)*Math.floor((e+9)/10)*16;case Zu:return Math.floor((n+11)/12)*Math.floor((e+9)/10)*16;case Ku:return Math.floor((n+11)/12)*Math.floor((e+11)/12)*16;case Ju:case ju:case Qu:return Math.ceil(n/4)*Math.ceil(e/4)*16;case eh:case th:return Math.ceil(n/4)*Math.ceil(e/4)*8;case Ml:case nh:return Math.ceil(n/4)*Math.ceil(e/4)*16}throw new Error(`Unable to determine texture byte length for ${t} format.`)}function eb(n){switch(n){case Ii:case fd:return{byteLength:1,components:1};case ua:case dd:case rs:return{byteLength:2,components:1};case Su:case Mu:return{byteLength:2,components:4};case is:case bu:case ss:return{byteLength:4,components:1};case pd:case md:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${n}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:"187"}}));typeof window<"u"&&(window.__THREE__?Ye("WARNING: Multiple instances of Three.js being imported."):window.__THREE__="187");function U_(){let n=null,e=!1,t=null,i=null;function s(r,o){i=n.requestAnimationFrame(s),t(r,o)}return{start:function(){e!==!0&&t!==null&&n!==null&&(i=n.requestAnimationFrame(s),e=!0)},stop:function(){n!==null&&n.cancelAnimationFrame(i),e=!1},setAnimationLoop:function(r){t=r},setContext:function(r){n=r}}}function nb(n){let e=new WeakMap;function t(a,l){let c=a.array,u=a.usage,h=c.byteLength,f=n.createBuffer();n.bindBuffer(l,f),n.bufferData(l,c,u),a.onUploadCallback();let d;if(c instanceof Float32Array)d=n.FLOAT;else if(typeof Float16Array<"u"&&c instanceof Float16Array)d=n.HALF_FLOAT;else if(c instanceof Uint16Array)a.isFloat16BufferAttribute?d=n.HALF_FLOAT:d=n.UNSIGNED_SHORT;else if(c instanceof Int16Array)d=n.SHORT;else if(c instanceof Uint32Array)d=n.UNSIGNED_INT;else if(c instanceof Int32Array)d=n.INT;else if(c instanceof Int8Array)d=n.BYTE;else if(c instanceof Uint8Array)d=n.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)d=n.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:f,type:d,bytesPerElement:c.BYTES_PER_ELEMENT,version:a.version,size:h}}function i(a,l,c){let u=l.array,h=l.updateRanges;if(n.bindBuffer(c,a),h.length===0)n.bufferSubData(c,0,u);else{h.sort((d,g)=>d.start-g.start);let f=0;for(let d=1;d<h.length;d++){let g=h[f],y=h[d];y.start<=g.start+g.count+1?g.count=Math.max(g.count,y.start+y.count-g.start):(++f,h[f]=y)}h.length=f+1;for(let d=0,g=h.length;d<g;d++){let y=h[d];n.bufferSubData(c,y.start*u.BYTES_PER_ELEMENT,u,y.start,y.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(a){return a.isInterleavedBufferAttribute&&(a=a.data),e.get(a)}function r(a){a.isInterleavedBufferAttribute&&(a=a.data);let l=e.get(a);l&&(n.deleteBuffer(l.buffer),e.delete(a))}function o(a,l){if(a.isInterleavedBufferAttribute&&(a=a.data),a.isGLBufferAttribute){let u=e.get(a);(!u||u.version<a.version)&&e.set(a,{buffer:a.buffer,type:a.type,bytesPerElement:a.elementSize,version:a.version});return}let c=e.get(a);if(c===void 0)e.set(a,t(a,l));else if(c.version<a.version){if(c.size!==a.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");i(c.buffer,a,l),c.version=a.version}}return{get:s,remove:r,update:o}}var ib=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,sb=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,rb=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,ob=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,ab=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,lb=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,cb=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,ub=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,hb=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,fb=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,db=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,pb=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,mb=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,gb=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,_b=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,vb=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,xb=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,yb=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,bb=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,Sb=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,Mb=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,wb=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,Tb=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,Ab=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,Eb=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,Cb=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,Rb=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,Pb=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,Ib=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,Lb="gl_FragColor = linearToOutputTexel( gl_FragColor );",Db=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,Nb=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,Ub=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,Ob=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,Fb=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,Bb=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,kb=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,zb=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,Vb=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,Gb=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,Hb=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,Wb=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,Xb=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,qb=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,Yb=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,$b=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,Zb=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,Kb=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,Jb=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,jb=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,Qb=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,eS=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,tS=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,nS=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,iS=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,sS=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,rS=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,oS=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,aS=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,lS=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,cS=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,uS=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,hS=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,fS=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,dS=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,pS=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,mS=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,gS=`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,_S=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,vS=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,xS=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,yS=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,bS=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,SS=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,MS=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,wS=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,TS=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,AS=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,ES=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,CS=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,RS=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,PS=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,IS=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,LS=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,DS=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,NS=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,US=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,OS=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,FS=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,BS=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,kS=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,zS=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,VS=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,GS=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,HS=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,WS=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,XS=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,qS=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,YS=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,$S=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,ZS=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,KS=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,JS=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,jS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,QS=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,eM=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,tM=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,nM=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,iM=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,sM=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,rM=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,oM=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,aM=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,lM=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,cM=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,uM=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,hM=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,fM=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,dM=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,pM=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,mM=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,gM=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,_M=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,vM=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,xM=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,yM=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,bM=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,SM=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,MM=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,wM=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,TM=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,AM=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,EM=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,CM=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,RM=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,PM=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,IM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,LM=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,DM=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,NM=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,UM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,ft={alphahash_fragment:ib,alphahash_pars_fragment:sb,alphamap_fragment:rb,alphamap_pars_fragment:ob,alphatest_fragment:ab,alphatest_pars_fragment:lb,aomap_fragment:cb,aomap_pars_fragment:ub,batching_pars_vertex:hb,batching_vertex:fb,begin_vertex:db,beginnormal_vertex:pb,bsdfs:mb,iridescence_fragment:gb,bumpmap_pars_fragment:_b,clipping_planes_fragment:vb,clipping_planes_pars_fragment:xb,clipping_planes_pars_vertex:yb,clipping_planes_vertex:bb,color_fragment:Sb,color_pars_fragment:Mb,color_pars_vertex:wb,color_vertex:Tb,common:Ab,defaultnormal_vertex:Eb,displacementmap_pars_vertex:Cb,displacementmap_vertex:Rb,emissivemap_fragment:Pb,emissivemap_pars_fragment:Ib,colorspace_fragment:Lb,colorspace_pars_fragment:Db,envmap_fragment:Nb,envmap_common_pars_fragment:Ub,envmap_pars_fragment:Ob,envmap_pars_vertex:Fb,envmap_physical_pars_fragment:$b,envmap_vertex:Bb,fog_vertex:kb,fog_pars_vertex:zb,fog_fragment:Vb,fog_pars_fragment:Gb,gradientmap_pars_fragment:Hb,lightmap_pars_fragment:Wb,lights_lambert_fragment:Xb,lights_lambert_pars_fragment:qb,lights_pars_begin:Yb,lights_toon_fragment:Zb,lights_toon_pars_fragment:Kb,lights_phong_fragment:Jb,lights_phong_pars_fragment:jb,lights_physical_fragment:Qb,lights_physical_pars_fragment:eS,lights_fragment_begin:tS,lights_fragment_maps:nS,lights_fragment_end:iS,lightprobes_pars_fragment:sS,logdepthbuf_fragment:rS,logdepthbuf_pars_fragment:oS,logdepthbuf_pars_vertex:aS,logdepthbuf_vertex:lS,map_fragment:cS,map_pars_fragment:uS,map_particle_fragment:hS,map_particle_pars_fragment:fS,metalnessmap_fragment:dS,metalnessmap_pars_fragment:pS,morphinstance_vertex:mS,morphcolor_vertex:gS,morphnormal_vertex:_S,morphtarget_pars_vertex:vS,morphtarget_vertex:xS,normal_fragment_begin:yS,normal_fragment_maps:bS,normal_pars_fragment:SS,normal_pars_vertex:MS,normal_vertex:wS,normalmap_pars_fragment:TS,clearcoat_normal_fragment_begin:AS,clearcoat_normal_fragment_maps:ES,clearcoat_pars_fragment:CS,iridescence_pars_fragment:RS,opaque_fragment:PS,packing:IS,premultiplied_alpha_fragment:LS,project_vertex:DS,dithering_fragment:NS,dithering_pars_fragment:US,roughnessmap_fragment:OS,roughnessmap_pars_fragment:FS,shadowmap_pars_fragment:BS,shadowmap_pars_vertex:kS,shadowmap_vertex:zS,shadowmask_pars_fragment:VS,skinbase_vertex:GS,skinning_pars_vertex:HS,skinning_vertex:WS,skinnormal_vertex:XS,specularmap_fragment:qS,specularmap_pars_fragment:YS,tonemapping_fragment:$S,tonemapping_pars_fragment:ZS,transmission_fragment:KS,transmission_pars_fragment:JS,uv_pars_fragment:jS,uv_pars_vertex:QS,uv_vertex:eM,worldpos_vertex:tM,background_vert:nM,background_frag:iM,backgroundCube_vert:sM,backgroundCube_frag:rM,cube_vert:oM,cube_frag:aM,depth_vert:lM,depth_frag:cM,distance_vert:uM,distance_frag:hM,equirect_vert:fM,equirect_frag:dM,linedashed_vert:pM,linedashed_frag:mM,meshbasic_vert:gM,meshbasic_frag:_M,meshlambert_vert:vM,meshlambert_frag:xM,meshmatcap_vert:yM,meshmatcap_frag:bM,meshnormal_vert:SM,meshnormal_frag:MM,meshphong_vert:wM,meshphong_frag:TM,meshphysical_vert:AM,meshphysical_frag:EM,meshtoon_vert:CM,meshtoon_frag:RM,points_vert:PM,points_frag:IM,shadow_vert:LM,shadow_frag:DM,sprite_vert:NM,sprite_frag:UM},Le={common:{diffuse:{value:new yt(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new nt},alphaMap:{value:null},alphaMapTransform:{value:new nt},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new nt}},envmap:{envMap:{value:null},envMapRotation:{value:new nt},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new nt}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new nt}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new nt},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new nt},normalScale:{value:new tt(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new nt},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new nt}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new nt}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new nt}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new yt(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new yt(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new nt},alphaTest:{value:0},uvTransform:{value:new nt}},sprite:{diffuse:{value:new yt(16777215)},opacity:{value:1},center:{value:new tt(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new nt},alphaMap:{value:null},alphaMapTransform:{value:new nt},alphaTest:{value:0}}},As={basic:{uniforms:ei([Le.common,Le.specularmap,Le.envmap,Le.aomap,Le.lightmap,Le.fog]),vertexShader:ft.meshbasic_vert,fragmentShader:ft.meshbasic_frag},lambert:{uniforms:ei([Le.common,Le.specularmap,Le.envmap,Le.aomap,Le.lightmap,Le.emissivemap,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.fog,Le.lights,{emissive:{value:new yt(0)},envMapIntensity:{value:1}}]),vertexShader:ft.meshlambert_vert,fragmentShader:ft.meshlambert_frag},phong:{uniforms:ei([Le.common,Le.specularmap,Le.envmap,Le.aomap,Le.lightmap,Le.emissivemap,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.fog,Le.lights,{emissive:{value:new yt(0)},specular:{value:new yt(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:ft.meshphong_vert,fragmentShader:ft.meshphong_frag},standard:{uniforms:ei([Le.common,Le.envmap,Le.aomap,Le.lightmap,Le.emissivemap,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.roughnessmap,Le.metalnessmap,Le.fog,Le.lights,{emissive:{value:new yt(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:ft.meshphysical_vert,fragmentShader:ft.meshphysical_frag},toon:{uniforms:ei([Le.common,Le.aomap,Le.lightmap,Le.emissivemap,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.gradientmap,Le.fog,Le.lights,{emissive:{value:new yt(0)}}]),vertexShader:ft.meshtoon_vert,fragmentShader:ft.meshtoon_frag},matcap:{uniforms:ei([Le.common,Le.bumpmap,Le.normalmap,Le.displacementmap,Le.fog,{matcap:{value:null}}]),vertexShader:ft.meshmatcap_vert,fragmentShader:ft.meshmatcap_frag},points:{uniforms:ei([Le.points,Le.fog]),vertexShader:ft.points_vert,fragmentShader:ft.points_frag},dashed:{uniforms:ei([Le.common,Le.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:ft.linedashed_vert,fragmentShader:ft.linedashed_frag},depth:{uniforms:ei([Le.common,Le.displacementmap]),vertexShader:ft.depth_vert,fragmentShader:ft.depth_frag},normal:{uniforms:ei([Le.common,Le.bumpmap,Le.normalmap,Le.displacementmap,{opacity:{value:1}}]),vertexShader:ft.meshnormal_vert,fragmentShader:ft.meshnormal_frag},sprite:{uniforms:ei([Le.sprite,Le.fog]),vertexShader:ft.sprite_vert,fragmentShader:ft.sprite_frag},background:{uniforms:{uvTransform:{value:new nt},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:ft.background_vert,fragmentShader:ft.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new nt}},vertexShader:ft.backgroundCube_vert,fragmentShader:ft.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:ft.cube_vert,fragmentShader:ft.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:ft.equirect_vert,fragmentShader:ft.equirect_frag},distance:{uniforms:ei([Le.common,Le.displacementmap,{referencePosition:{value:new V},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:ft.distance_vert,fragmentShader:ft.distance_frag},shadow:{uniforms:ei([Le.lights,Le.fog,{color:{value:new yt(0)},opacity:{value:1}}]),vertexShader:ft.shadow_vert,fragmentShader:ft.shadow_frag}};As.physical={uniforms:ei([As.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new nt},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new nt},clearcoatNormalScale:{value:new tt(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new nt},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new nt},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new nt},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new nt},sheen:{value:0},sheenColor:{value:new yt(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new nt},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new nt},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new nt},transmissionSamplerSize:{value:new tt},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new nt},attenuationDistance:{value:0},attenuationColor:{value:new yt(0)},specularColor:{value:new yt(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new nt},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new nt},anisotropyVector:{value:new tt},anisotropyMap:{value:null},anisotropyMapTransform:{value:new nt}}]),vertexShader:ft.meshphysical_vert,fragmentShader:ft.meshphysical_frag};var ih={r:0,b:0,g:0},OM=new Mt,O_=new nt;O_.set(-1,0,0,0,1,0,0,0,1);function FM(n,e,t,i,s,r){let o=new yt(0),a=s===!0?0:1,l,c,u=null,h=0,f=null;function d(x){let R=x.isScene===!0?x.background:null;if(R&&R.isTexture){let S=x.backgroundBlurriness>0;R=e.get(R,S)}return R}function g(x){let R=!1,S=d(x);S===null?p(o,a):S&&S.isColor&&(p(S,1),R=!0);let C=n.xr.getEnvironmentBlendMode();C==="additive"?t.buffers.color.setClear(0,0,0,1,r):C==="alpha-blend"&&t.buffers.color.setClear(0,0,0,0,r),(n.autoClear||R)&&(t.buffers.depth.setTest(!0),t.buffers.depth.setMask(!0),t.buffers.color.setMask(!0),n.clear(n.autoClearColor,n.autoClearDepth,n.autoClearStencil))}function y(x,R){let S=d(R);S&&S.isCubeTexture?(c===void 0&&(c=new zi(new ia(1,1,1),new Vi({name:"BackgroundCubeMaterial",uniforms:to(As.backgroundCube.uniforms),vertexShader:As.backgroundCube.vertexShader,fragmentShader:As.backgroundCube.fragmentShader,side:pi,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),c.geometry.deleteAttribute("uv"),c.onBeforeRender=function(C,E,v){this.matrixWorld.copyPosition(v.matrixWorld)},Object.defineProperty(c.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),i.update(c)),c.material.uniforms.envMap.value=S,c.material.uniforms.backgroundBlurriness.value=R.backgroundBlurriness,c.material.uniforms.backgroundIntensity.value=R.backgroundIntensity,c.material.uniforms.backgroundRotation.value.setFromMatrix4(OM.makeRotationFromEuler(R.backgroundRotation)).transpose(),S.isRenderTargetTexture===!1&&c.material.uniforms.backgroundRotation.value.premultiply(O_),c.material.toneMapped=_t.getTransfer(S.colorSpace)!==Nt,(u!==S||h!==S.version||f!==n.toneMapping)&&(c.material.needsUpdate=!0,u=S,h=S.version,f=n.toneMapping),c.layers.enableAll(),x.unshift(c,c.geometry,c.material,0,0,null)):S&&S.isTexture&&(l===void 0&&(l=new zi(new ul(2,2),new Vi({name:"BackgroundMaterial",uniforms:to(As.background.uniforms),vertexShader:As.background.vertexShader,fragmentShader:As.background.fragmentShader,side:Cr,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute("normal"),Object.defineProperty(l.material,"map",{get:function(){return this.uniforms.t2D.value}}),i.update(l)),l.material.uniforms.t2D.value=S,l.material.uniforms.backgroundIntensity.value=R.backgroundIntensity,l.material.toneMapped=_t.getTransfer(S.colorSpace)!==Nt,S.matrixAutoUpdate===!0&&S.updateMatrix(),l.material.uniforms.uvTransform.value.copy(S.matrix),(u!==S||h!==S.version||f!==n.toneMapping)&&(l.material.needsUpdate=!0,u=S,h=S.version,f=n.toneMapping),l.layers.enableAll(),x.unshift(l,l.geometry,l.material,0,0,null))}function p(x,R){x.getRGB(ih,Rd(n)),t.buffers.color.setClear(ih.r,ih.g,ih.b,R,r)}function m(){c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0),l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0)}return{getClearColor:function(){return o},setClearColor:function(x,R=1){o.set(x),a=R,p(o,a)},getClearAlpha:function(){return a},setClearAlpha:function(x){a=x,p(o,a)},render:g,addToRenderList:y,dispose:m}}function BM(n,e){let t=n.getParameter(n.MAX_VERTEX_ATTRIBS),i={},s=f(null),r=s,o=!1;function a(D,W,G,U,X){let K=!1,H=h(D,U,G,W);r!==H&&(r=H,c(r.object)),K=d(D,U,G,X),K&&g(D,U,G,X),X!==null&&e.update(X,n.ELEMENT_ARRAY_BUFFER),(K||o)&&(o=!1,S(D,W,G,U),X!==null&&n.bindBuffer(n.ELEMENT_ARRAY_BUFFER,e.get(X).buffer))}function l(){return n.createVertexArray()}function c(D){return n.bindVertexArray(D)}function u(D){return n.deleteVertexArray(D)}function h(D,W,G,U){let X=U.wireframe===!0,K=i[W.id];K===void 0&&(K={},i[W.id]=K);let H=D.isInstancedMesh===!0?D.id:0,ce=K[H];ce===void 0&&(ce={},K[H]=ce);let J=ce[G.id];J===void 0&&(J={},ce[G.id]=J);let Q=J[X];return Q===void 0&&(Q=f(l()),J[X]=Q),Q}function f(D){let W=[],G=[],U=[];for(let X=0;X<t;X++)W[X]=0,G[X]=0,U[X]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:W,enabledAttributes:G,attributeDivisors:U,object:D,attributes:{},index:null}}function d(D,W,G,U){let X=r.attributes,K=W.attributes,H=0,ce=G.getAttributes();for(let J in ce)if(ce[J].location>=0){let se=X[J],fe=K[J];if(fe===void 0&&(J==="instanceMatrix"&&D.instanceMatrix&&(fe=D.instanceMatrix),J==="instanceColor"&&D.instanceColor&&(fe=D.instanceColor)),se===void 0||se.attribute!==fe||fe&&se.data!==fe.data)return!0;H++}return r.attributesNum!==H||r.index!==U}function g(D,W,G,U){let X={},K=W.attributes,H=0,ce=G.getAttributes();for(let J in ce)if(ce[J].location>=0){let se=K[J];se===void 0&&(J==="instanceMatrix"&&D.instanceMatrix&&(se=D.instanceMatrix),J==="instanceColor"&&D.instanceColor&&(se=D.instanceColor));let fe={};fe.attribute=se,se&&se.data&&(fe.data=se.data),X[J]=fe,H++}r.attributes=X,r.attributesNum=H,r.index=U}function y(){let D=r.newAttributes;for(let W=0,G=D.length;W<G;W++)D[W]=0}function p(D){m(D,0)}function m(D,W){let G=r.newAttributes,U=r.enabledAttributes,X=r.attributeDivisors;G[D]=1,U[D]===0&&(n.enableVertexAttribArray(D),U[D]=1),X[D]!==W&&(n.vertexAttribDivisor(D,W),X[D]=W)}function x(){let D=r.newAttributes,W=r.enabledAttributes;for(let G=0,U=W.length;G<U;G++)W[G]!==D[G]&&(n.disableVertexAttribArray(G),W[G]=0)}function R(D,W,G,U,X,K,H){H===!0?n.vertexAttribIPointer(D,W,G,X,K):n.vertexAttribPointer(D,W,G,U,X,K)}function S(D,W,G,U){y();let X=U.attributes,K=G.getAttributes(),H=W.defaultAttributeValues;for(let ce in K){let J=K[ce];if(J.location>=0){let Q=X[ce];if(Q===void 0&&(ce==="instanceMatrix"&&D.instanceMatrix&&(Q=D.instanceMatrix),ce==="instanceColor"&&D.instanceColor&&(Q=D.instanceColor)),Q!==void 0){let se=Q.normalized,fe=Q.itemSize,he=e.get(Q);if(he===void 0)continue;let ee=he.buffer,me=he.type,ve=he.bytesPerElement,Ee=me===n.INT||me===n.UNSIGNED_INT||Q.gpuType===bu;if(Q.isInterleavedBufferAttribute){let Se=Q.data,We=Se.isInterleavedBuffer===!0?Se.stride:Se.itemSize,at=Q.offset;if(Se.isInstancedInterleavedBuffer||Se.isInstancedBufferAttribute){for(let Ge=0;Ge<J.locationSize;Ge++)m(J.location+Ge,Se.meshPerAttribute);D.isInstancedMesh!==!0&&U._maxInstanceCount===void 0&&(U._maxInstanceCount=Se.meshPerAttribute*Se.count)}else for(let Ge=0;Ge<J.locationSize;Ge++)p(J.location+Ge);n.bindBuffer(n.ARRAY_BUFFER,ee);for(let Ge=0;Ge<J.locationSize;Ge++)R(J.location+Ge,fe/J.locationSize,me,se,We*ve,(at+fe/J.locationSize*Ge)*ve,Ee)}else{if(Q.isInstancedBufferAttribute){for(let Se=0;Se<J.locationSize;Se++)m(J.location+Se,Q.meshPerAttribute);D.isInstancedMesh!==!0&&U._maxInstanceCount===void 0&&(U._maxInstanceCount=Q.meshPerAttribute*Q.count)}else for(let Se=0;Se<J.locationSize;Se++)p(J.location+Se);n.bindBuffer(n.ARRAY_BUFFER,ee);for(let Se=0;Se<J.locationSize;Se++)R(J.location+Se,fe/J.locationSize,me,se,fe*ve,fe/J.locationSize*Se*ve,Ee)}}else if(H!==void 0){let se=H[ce];if(se!==void 0)switch(se.length){case 2:n.vertexAttrib2fv(J.location,se);break;case 3:n.vertexAttrib3fv(J.location,se);break;case 4:n.vertexAttrib4fv(J.location,se);break;default:n.vertexAttrib1fv(J.location,se)}}}}x()}function C(){z();for(let D in i){let W=i[D];for(let G in W){let U=W[G];for(let X in U){let K=U[X];for(let H in K)u(K[H].object),delete K[H];delete U[X]}}delete i[D]}}function E(D){if(i[D.id]===void 0)return;let W=i[D.id];for(let G in W){let U=W[G];for(let X in U){let K=U[X];for(let H in K)u(K[H].object),delete K[H];delete U[X]}}delete i[D.id]}function v(D){for(let W in i){let G=i[W];for(let U in G){let X=G[U];if(X[D.id]===void 0)continue;let K=X[D.id];for(let H in K)u(K[H].object),delete K[H];delete X[D.id]}}}function T(D){for(let W in i){let G=i[W],U=D.isInstancedMesh===!0?D.id:0,X=G[U];if(X!==void 0){for(let K in X){let H=X[K];for(let ce in H)u(H[ce].object),delete H[ce];delete X[K]}delete G[U],Object.keys(G).length===0&&delete i[W]}}}function z(){N(),o=!0,r!==s&&(r=s,c(r.object))}function N(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:a,reset:z,resetDefaultState:N,dispose:C,releaseStatesOfGeometry:E,releaseStatesOfObject:T,releaseStatesOfProgram:v,initAttributes:y,enableAttribute:p,disableUnusedAttributes:x}}function kM(n,e,t){let i;function s(l){i=l}function r(l,c){n.drawArrays(i,l,c),t.update(c,i,1)}function o(l,c,u){u!==0&&(n.drawArraysInstanced(i,l,c,u),t.update(c,i,u))}function a(l,c,u){if(u===0)return;e.get("WEBGL_multi_draw").multiDrawArraysWEBGL(i,l,0,c,0,u);let f=0;for(let d=0;d<u;d++)f+=c[d];t.update(f,i,1)}this.setMode=s,this.render=r,this.renderInstances=o,this.renderMultiDraw=a}function zM(n,e,t,i){let s;function r(){if(s!==void 0)return s;if(e.has("EXT_texture_filter_anisotropic")===!0){let v=e.get("EXT_texture_filter_anisotropic");s=n.getParameter(v.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function o(v){return!(v!==os&&i.convert(v)!==n.getParameter(n.IMPLEMENTATION_COLOR_READ_FORMAT))}function a(v){let T=v===rs&&(e.has("EXT_color_buffer_half_float")||e.has("EXT_color_buffer_float"));return!(v!==Ii&&v!==ss&&!T&&i.convert(v)!==n.getParameter(n.IMPLEMENTATION_COLOR_READ_TYPE))}function l(v){if(v==="highp"){if(n.getShaderPrecisionFormat(n.VERTEX_SHADER,n.HIGH_FLOAT).precision>0&&n.getShaderPrecisionFormat(n.FRAGMENT_SHADER,n.HIGH_FLOAT).precision>0)return"highp";v="mediump"}return v==="mediump"&&n.getShaderPrecisionFormat(n.VERTEX_SHADER,n.MEDIUM_FLOAT).precision>0&&n.getShaderPrecisionFormat(n.FRAGMENT_SHADER,n.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=t.precision!==void 0?t.precision:"highp",u=l(c);u!==c&&(Ye("WebGLRenderer:",c,"not supported, using",u,"instead."),c=u);let h=t.reversedDepthBuffer===!0&&e.has("EXT_clip_control"),f=t.logarithmicDepthBuffer===!0&&h===!1;t.reversedDepthBuffer===!0&&h===!1&&Ye("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),t.logarithmicDepthBuffer===!0&&h===!0&&Ye("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let d=n.getParameter(n.MAX_TEXTURE_IMAGE_UNITS),g=n.getParameter(n.MAX_VERTEX_TEXTURE_IMAGE_UNITS),y=n.getParameter(n.MAX_TEXTURE_SIZE),p=n.getParameter(n.MAX_CUBE_MAP_TEXTURE_SIZE),m=n.getParameter(n.MAX_VERTEX_ATTRIBS),x=n.getParameter(n.MAX_VERTEX_UNIFORM_VECTORS),R=n.getParameter(n.MAX_VARYING_VECTORS),S=n.getParameter(n.MAX_FRAGMENT_UNIFORM_VECTORS),C=n.getParameter(n.MAX_SAMPLES),E=n.getParameter(n.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:o,textureTypeReadable:a,precision:c,logarithmicDepthBuffer:f,reversedDepthBuffer:h,maxTextures:d,maxVertexTextures:g,maxTextureSize:y,maxCubemapSize:p,maxAttributes:m,maxVertexUniforms:x,maxVaryings:R,maxFragmentUniforms:S,maxSamples:C,samples:E}}function VM(n){let e=this,t=null,i=0,s=!1,r=!1,o=new ui,a=new nt,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(h,f){let d=h.length!==0||f||i!==0||s;return s=f,i=h.length,d},this.beginShadows=function(){r=!0,u(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(h,f){t=u(h,f,0)},this.setState=function(h,f,d){let g=h.clippingPlanes,y=h.clipIntersection,p=h.clipShadows,m=n.get(h);if(!s||g===null||g.length===0||r&&!p)r?u(null):c();else{let x=r?0:i,R=x*4,S=m.clippingState||null;l.value=S,S=u(g,f,R,d);for(let C=0;C!==R;++C)S[C]=t[C];m.clippingState=S,this.numIntersection=y?this.numPlanes:0,this.numPlanes+=x}};function c(){l.value!==t&&(l.value=t,l.needsUpdate=i>0),e.numPlanes=i,e.numIntersection=0}function u(h,f,d,g){let y=h!==null?h.length:0,p=null;if(y!==0){if(p=l.value,g!==!0||p===null){let m=d+y*4,x=f.matrixWorldInverse;a.getNormalMatrix(x),(p===null||p.length<m)&&(p=new Float32Array(m));for(let R=0,S=d;R!==y;++R,S+=4)o.copy(h[R]).applyMatrix4(x,a),o.normal.toArray(p,S),p[S+3]=o.constant}l.value=p,l.needsUpdate=!0}return e.numPlanes=y,e.numIntersection=0,p}}var Al=class extends Ri{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let i={width:e,height:e,depth:1},s=[i,i,i,i,i,i];this.texture=new al(s),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let i={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new ia(5,5,5),r=new Vi({name:"CubemapFromEquirect",uniforms:to(i.uniforms),vertexShader:i.vertexShader,fragmentShader:i.fragmentShader,side:pi,blending:Jr});r.uniforms.tEquirect.value=t;let o=new zi(s,r),a=t.minFilter;return t.minFilter===Ks&&(t.minFilter=fi),new ra(1,10,this).update(e,o),t.minFilter=a,o.geometry.dispose(),o.material.dispose(),this}clear(e,t=!0,i=!0,s=!0){let r=e.getRenderTarget();for(let o=0;o<6;o++)e.setRenderTarget(this,o),e.clear(t,i,s);e.setRenderTarget(r)}},p_=256,GM=3,HM=20,F_=256,B_=16,WM=3,XM=new V,qM=new yt,rh=class n{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new ra(1,10,null),this._boxMesh=new zi(new ia(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,i=.1,s=100,r={}){let{size:o=256,position:a=XM}=r,l=this._renderer;this._setSize(o);let c=this._allocateTarget(),u=this._getSourceTarget(!0);t>0&&(u.texture.mipmapsAutoUpdate=!1);let h=l.autoClear,f=l.autoClearColor,d=l.autoClearDepth,g=l.autoClearStencil,y=e.background;l.autoClear=!0,l.autoClearColor=!0,l.autoClearDepth=!0,l.autoClearStencil=!0,y===null&&(e.background=l.getClearColor(qM));let p=new ra(i,s,u);return p.position.copy(a),p.update(l,e),l.autoClear=h,l.autoClearColor=f,l.autoClearDepth=d,l.autoClearStencil=g,e.background=y,t>0&&(u.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=__(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=g_(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(p_,Ad(e))}_fromTexture(e,t){e.mapping===Qr||e.mapping===ca?this._setSize(e.image.length===0?p_:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let i=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(i),i}_allocateTarget(){let e=this._cubeSize,t=m_(e,!1,!1),i=Math.log2(e)-GM;for(let s=0;s<=i;s++)t.texture.mipmaps.push({width:e>>s,height:e>>s});return t.texture.name="PMREM",t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,i=this._sourceTarget;return(i===null||i.width!==t||e&&i.depthBuffer===!1)&&(i!==null&&i.dispose(),this._sourceTarget=m_(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,i){let s=this._boxMesh,r=this._cubeCamera;s.material=i,r.renderTarget=e,r.activeMipmapLevel=t;let o=e.width>>t;e.viewport.set(0,0,o,o),r.update(this._renderer,s),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===Qr||e.mapping===ca?(this._cubemapMaterial===null&&(this._cubemapMaterial=__()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=g_()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(e){this._ggxMaterial===null&&(this._ggxMaterial=YM(),this._integrationMaterial=$M());let t=this._cubeSize,i=e.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;let r=this._integrationMaterial.uniforms;r.envMap.value=this._sourceTarget.texture,r.sourceLod.value=Math.log2(t/B_);for(let o=0;o<=i;o++){let a=n.lodToRoughness(o,i);if(o>i-WM)r.roughness.value=a,this._renderCube(e,o,this._integrationMaterial);else{let l=a>0?Math.log2(t)+.5*Math.log2(6/(F_*Math.pow(a,4)))+.5:0;s.roughness.value=a,s.lodBias.value=l,this._renderCube(e,o,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=ZM());let i=this._blurMaterial,s=i.uniforms,r=this._sourceTarget;s.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this._renderCube(e,0,i),s.envMap.value=e.texture,this._renderCube(r,0,i)}};function m_(n,e,t){return new Al(n,{minFilter:Ks,generateMipmaps:e,type:rs,colorSpace:Zr,depthBuffer:t})}function El(n,e,t){return new Vi({name:n,uniforms:e,vertexShader:ft.cube_vert,fragmentShader:t,side:pi,blending:Jr,depthTest:!1,depthWrite:!1})}function YM(){return El("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${F_}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function $M(){return El("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:B_}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function ZM(){return El("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${HM}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function g_(){return El("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function __(){return El("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function KM(n){let e=new WeakMap,t=new WeakMap,i=null;function s(f,d=!1){return f==null?null:d?o(f):r(f)}function r(f){if(f&&f.isTexture){let d=f.mapping;if(d===vu||d===xu)if(e.has(f)){let g=e.get(f).texture;return a(g,f.mapping)}else{let g=f.image;if(g&&g.height>0){let y=new Al(g.height);return y.fromEquirectangularTexture(n,f),e.set(f,y),f.addEventListener("dispose",c),a(y.texture,f.mapping)}else return null}}return f}function o(f){if(f&&f.isTexture&&f.isPMREMTexture!==!0){let d=f.mapping,g=d===vu||d===xu,y=d===Qr||d===ca;if(g||y){let p=t.get(f),m=p!==void 0?p.texture.pmremVersion:0;if(f.isRenderTargetTexture&&f.pmremVersion!==m)return i===null&&(i=new rh(n)),p=g?i.fromEquirectangular(f,p):i.fromCubemap(f,p),p.texture.pmremVersion=f.pmremVersion,t.set(f,p),p.texture;if(p!==void 0)return p.texture;{let x=f.image;return g&&x&&x.height>0||y&&x&&l(x)?(i===null&&(i=new rh(n)),p=g?i.fromEquirectangular(f):i.fromCubemap(f),p.texture.pmremVersion=f.pmremVersion,t.set(f,p),f.addEventListener("dispose",u),p.texture):null}}}return f}function a(f,d){return d===vu?f.mapping=Qr:d===xu&&(f.mapping=ca),f}function l(f){let d=0,g=6;for(let y=0;y<g;y++)f[y]!==void 0&&d++;return d===g}function c(f){let d=f.target;d.removeEventListener("dispose",c);let g=e.get(d);g!==void 0&&(e.delete(d),g.dispose())}function u(f){let d=f.target;d.removeEventListener("dispose",u);let g=t.get(d);g!==void 0&&(t.delete(d),g.dispose())}function h(){e=new WeakMap,t=new WeakMap,i!==null&&(i.dispose(),i=null)}return{get:s,dispose:h}}function JM(n){let e={};function t(i){if(e[i]!==void 0)return e[i];let s=n.getExtension(i);return e[i]=s,s}return{has:function(i){return t(i)!==null},init:function(){t("EXT_color_buffer_float"),t("WEBGL_clip_cull_distance"),t("OES_texture_float_linear"),t("EXT_color_buffer_half_float"),t("WEBGL_multisampled_render_to_texture"),t("WEBGL_render_shared_exponent")},get:function(i){let s=t(i);return s===null&&Ka("WebGLRenderer: "+i+" extension not supported."),s}}}function jM(n,e,t,i){let s={},r=new WeakMap,o=new FinalizationRegistry(g=>delete s[g]);function a(g){l(g.target)}function l(g){g.index!==null&&e.remove(g.index);for(let p in g.attributes)e.remove(g.attributes[p]);g.removeEventListener("dispose",a),delete s[g.id],o.unregister(g);let y=r.get(g);y&&(e.remove(y),r.delete(g)),i.releaseStatesOfGeometry(g),g.isInstancedBufferGeometry===!0&&delete g._maxInstanceCount,t.memory.geometries--}function c(g,y){return s[y.id]!==void 0||(y.addEventListener("dispose",a),s[y.id]=new WeakRef(y),o.register(y,y.id,y),t.memory.geometries++),y}function u(g){let y=g.attributes;for(let p in y)e.update(y[p],n.ARRAY_BUFFER)}function h(g){let y=g.index,p=g.attributes.position,m=0;if(p===void 0)return;let x=y!==null?y.array.length:p.array.length/3-1,R=p.count>=65535?ol:rl,S=new R(Math.ceil(x/3)*6,1),C=S.array;if(y!==null){let v=y.array;m=y.version;for(let T=0,z=0;T<x;T+=3){let N=v[T+0],D=v[T+1],W=v[T+2];C[z++]=N,C[z++]=D,C[z++]=D,C[z++]=W,C[z++]=W,C[z++]=N}}else{m=p.version;for(let v=0,T=0;v<x;v+=3){let z=v+0,N=v+1,D=v+2;C[T++]=z,C[T++]=N,C[T++]=N,C[T++]=D,C[T++]=D,C[T++]=z}}S.version=m;let E=r.get(g);E&&e.remove(E),r.set(g,S)}function f(g){let y=r.get(g);if(y){let p=g.index;p!==null&&y.version<p.version&&h(g)}else h(g);return r.get(g)}function d(){for(let g in s){let y=s[g].deref();y!==void 0&&l(y)}}return{get:c,update:u,getWireframeAttribute:f,dispose:d}}function QM(n,e,t){let i;function s(h){i=h}let r,o;function a(h){r=h.type,o=h.bytesPerElement}function l(h,f){n.drawElements(i,f,r,h*o),t.update(f,i,1)}function c(h,f,d){d!==0&&(n.drawElementsInstanced(i,f,r,h*o,d),t.update(f,i,d))}function u(h,f,d){if(d===0)return;e.get("WEBGL_multi_draw").multiDrawElementsWEBGL(i,f,0,r,h,0,d);let y=0;for(let p=0;p<d;p++)y+=f[p];t.update(y,i,1)}this.setMode=s,this.setIndex=a,this.render=l,this.renderInstances=c,this.renderMultiDraw=u}function ew(n){let e={geometries:0,textures:0},t={frame:0,calls:0,triangles:0,points:0,lines:0};function i(r,o,a){switch(t.calls++,o){case n.TRIANGLES:t.triangles+=a*(r/3);break;case n.LINES:t.lines+=a*(r/2);break;case n.LINE_STRIP:t.lines+=a*(r-1);break;case n.LINE_LOOP:t.lines+=a*r;break;case n.POINTS:t.points+=a*r;break;default:Qe("WebGLInfo: Unknown draw mode:",o);break}}function s(){t.calls=0,t.triangles=0,t.points=0,t.lines=0}return{memory:e,render:t,programs:null,autoReset:!0,reset:s,update:i}}function tw(n,e,t){let i=new WeakMap,s=new rn;function r(o,a,l){let c=o.morphTargetInfluences,u=a.morphAttributes.position||a.morphAttributes.normal||a.morphAttributes.color,h=u!==void 0?u.length:0,f=i.get(a);if(f===void 0||f.count!==h){let z=function(){v.dispose(),i.delete(a),a.removeEventListener("dispose",z)};f!==void 0&&f.texture.dispose();let d=a.morphAttributes.position!==void 0,g=a.morphAttributes.normal!==void 0,y=a.morphAttributes.color!==void 0,p=a.morphAttributes.position||[],m=a.morphAttributes.normal||[],x=a.morphAttributes.color||[],R=0;d===!0&&(R=1),g===!0&&(R=2),y===!0&&(R=3);let S=a.attributes.position.count*R,C=1;S>e.maxTextureSize&&(C=Math.ceil(S/e.maxTextureSize),S=e.maxTextureSize);let E=new Float32Array(S*C*4*h),v=new il(E,S,C,h);v.type=ss,v.needsUpdate=!0;let T=R*4;for(let N=0;N<h;N++){let D=p[N],W=m[N],G=x[N],U=S*C*4*N;for(let X=0;X<D.count;X++){let K=X*T;d===!0&&(s.fromBufferAttribute(D,X),E[U+K+0]=s.x,E[U+K+1]=s.y,E[U+K+2]=s.z,E[U+K+3]=0),g===!0&&(s.fromBufferAttribute(W,X),E[U+K+4]=s.x,E[U+K+5]=s.y,E[U+K+6]=s.z,E[U+K+7]=0),y===!0&&(s.fromBufferAttribute(G,X),E[U+K+8]=s.x,E[U+K+9]=s.y,E[U+K+10]=s.z,E[U+K+11]=G.itemSize===4?s.w:1)}}f={count:h,texture:v,size:new tt(S,C)},i.set(a,f),a.addEventListener("dispose",z)}if(o.isInstancedMesh===!0&&o.morphTexture!==null)l.getUniforms().setValue(n,"morphTexture",o.morphTexture,t);else{let d=0;for(let y=0;y<c.length;y++)d+=c[y];let g=a.morphTargetsRelative?1:1-d;l.getUniforms().setValue(n,"morphTargetBaseInfluence",g),l.getUniforms().setValue(n,"morphTargetInfluences",c)}l.getUniforms().setValue(n,"morphTargetsTexture",f.texture,t),l.getUniforms().setValue(n,"morphTargetsTextureSize",f.size)}return{update:r}}function nw(n,e,t,i,s){let r=new WeakMap;function o(c){let u=s.render.frame,h=c.geometry,f=e.get(c,h);if(r.get(f)!==u&&(e.update(f),r.set(f,u)),c.isInstancedMesh&&(c.hasEventListener("dispose",l)===!1&&c.addEventListener("dispose",l),r.get(c)!==u&&(t.update(c.instanceMatrix,n.ARRAY_BUFFER),c.instanceColor!==null&&t.update(c.instanceColor,n.ARRAY_BUFFER),r.set(c,u))),c.isSkinnedMesh){let d=c.skeleton;r.get(d)!==u&&(d.update(),r.set(d,u))}return f}function a(){r=new WeakMap}function l(c){let u=c.target;u.removeEventListener("dispose",l),i.releaseStatesOfObject(u),t.remove(u.instanceMatrix),u.instanceColor!==null&&t.remove(u.instanceColor)}return{update:o,dispose:a}}var iw={[sd]:"LINEAR_TONE_MAPPING",[rd]:"REINHARD_TONE_MAPPING",[od]:"CINEON_TONE_MAPPING",[ad]:"ACES_FILMIC_TONE_MAPPING",[cd]:"AGX_TONE_MAPPING",[ud]:"NEUTRAL_TONE_MAPPING",[ld]:"CUSTOM_TONE_MAPPING"};function sw(n,e,t,i,s,r){let o=new Ri(e,t,{type:n,depthBuffer:s,stencilBuffer:r,samples:i?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),a=null,l=null,c=null,u=new Gn;u.setAttribute("position",new qn([-1,3,0,-1,-1,0,3,-1,0],3)),u.setAttribute("uv",new qn([0,2,0,0,2,0],2));let h=new su({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),f=new zi(u,h),d=new sa(-1,1,1,-1,0,1),g=null,y=null,p=!1,m,x=null,R=[],S=!1;this.setSize=function(C,E){o.setSize(C,E),a!==null&&a.setSize(C,E),l!==null&&l.setSize(C,E);for(let v=0;v<R.length;v++){let T=R[v];T.setSize&&T.setSize(C,E)}},this.setEffects=function(C){R=C,S=R.length>0&&R[0].isRenderPass===!0;let E=o.width,v=o.height;R.length>0&&a===null&&(a=new Ri(E,v,{type:rs,depthBuffer:!1,stencilBuffer:!1}),l=new Ri(E,v,{type:rs,depthBuffer:!1,stencilBuffer:!1}));let T=s===!0&&R.some(z=>z.needsDepthTexture===!0);T!==(o.depthTexture!==null)&&(T===!0&&c===null&&(c=new Zs(E,v),r===!0&&(c.format=Js,c.type=eo)),o.dispose(),o.depthTexture=T?c:null,o.resolveDepthBuffer=T,o.storeMultisampledDepthBuffer=T);for(let z=0;z<R.length;z++){let N=R[z];N.setSize&&N.setSize(E,v),T&&N.needsDepthTexture===!0&&N.setDepthTexture&&N.setDepthTexture(c)}},this.begin=function(C,E){if(p||C.toneMapping===ws&&R.length===0)return!1;if(x=E,E!==null){let v=E.width,T=E.height;(o.width!==v||o.height!==T)&&this.setSize(v,T)}return S===!1&&C.setRenderTarget(o),m=C.toneMapping,C.toneMapping=ws,!0},this.hasRenderPass=function(){return S},this.end=function(C,E){C.toneMapping=m,p=!0;let v=o,T=a;for(let z=0;z<R.length;z++){let N=R[z];N.enabled!==!1&&(N.render(C,T,v,E),N.needsSwap!==!1&&(v=T,T=T===a?l:a))}if(g!==C.outputColorSpace||y!==C.toneMapping){g=C.outputColorSpace,y=C.toneMapping,h.defines={},_t.getTransfer(g)===Nt&&(h.defines.SRGB_TRANSFER="");let z=iw[y];z&&(h.defines[z]=""),h.needsUpdate=!0}h.uniforms.tDiffuse.value=v.texture,C.setRenderTarget(x),C.render(f,d),x=null,p=!1},this.isCompositing=function(){return p},this.dispose=function(){o.dispose(),a!==null&&a.dispose(),l!==null&&l.dispose(),u.dispose(),h.dispose()}}var k_=new vi,z_=new Zs(1,1),V_=new ll(1),G_=new il,H_=new jc,W_=new al,v_=[],x_=[],y_=new Float32Array(16),b_=new Float32Array(9),S_=new Float32Array(4);function da(n,e,t){let i=n[0];if(i<=0||i>0)return n;let s=e*t,r=v_[s];if(r===void 0&&(r=new Float32Array(s),v_[s]=r),e!==0){i.toArray(r,0);for(let o=1,a=0;o!==e;++o)a+=t,n[o].toArray(r,a)}return r}function Pn(n,e){if(n.length!==e.length)return!1;for(let t=0,i=n.length;t<i;t++)if(n[t]!==e[t])return!1;return!0}function In(n,e){for(let t=0,i=e.length;t<i;t++)n[t]=e[t]}function ah(n,e){let t=x_[e];t===void 0&&(t=new Int32Array(e),x_[e]=t);for(let i=0;i!==e;++i)t[i]=n.allocateTextureUnit();return t}function rw(n,e){let t=this.cache;t[0]!==e&&(n.uniform1f(this.addr,e),t[0]=e)}function ow(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(n.uniform2f(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Pn(t,e))return;n.uniform2fv(this.addr,e),In(t,e)}}function aw(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(n.uniform3f(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else if(e.r!==void 0)(t[0]!==e.r||t[1]!==e.g||t[2]!==e.b)&&(n.uniform3f(this.addr,e.r,e.g,e.b),t[0]=e.r,t[1]=e.g,t[2]=e.b);else{if(Pn(t,e))return;n.uniform3fv(this.addr,e),In(t,e)}}function lw(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(n.uniform4f(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Pn(t,e))return;n.uniform4fv(this.addr,e),In(t,e)}}function cw(n,e){let t=this.cache,i=e.elements;if(i===void 0){if(Pn(t,e))return;n.uniformMatrix2fv(this.addr,!1,e),In(t,e)}else{if(Pn(t,i))return;S_.set(i),n.uniformMatrix2fv(this.addr,!1,S_),In(t,i)}}function uw(n,e){let t=this.cache,i=e.elements;if(i===void 0){if(Pn(t,e))return;n.uniformMatrix3fv(this.addr,!1,e),In(t,e)}else{if(Pn(t,i))return;b_.set(i),n.uniformMatrix3fv(this.addr,!1,b_),In(t,i)}}function hw(n,e){let t=this.cache,i=e.elements;if(i===void 0){if(Pn(t,e))return;n.uniformMatrix4fv(this.addr,!1,e),In(t,e)}else{if(Pn(t,i))return;y_.set(i),n.uniformMatrix4fv(this.addr,!1,y_),In(t,i)}}function fw(n,e){let t=this.cache;t[0]!==e&&(n.uniform1i(this.addr,e),t[0]=e)}function dw(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(n.uniform2i(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Pn(t,e))return;n.uniform2iv(this.addr,e),In(t,e)}}function pw(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(n.uniform3i(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Pn(t,e))return;n.uniform3iv(this.addr,e),In(t,e)}}function mw(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(n.uniform4i(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Pn(t,e))return;n.uniform4iv(this.addr,e),In(t,e)}}function gw(n,e){let t=this.cache;t[0]!==e&&(n.uniform1ui(this.addr,e),t[0]=e)}function _w(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(n.uniform2ui(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Pn(t,e))return;n.uniform2uiv(this.addr,e),In(t,e)}}function vw(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(n.uniform3ui(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Pn(t,e))return;n.uniform3uiv(this.addr,e),In(t,e)}}function xw(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(n.uniform4ui(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Pn(t,e))return;n.uniform4uiv(this.addr,e),In(t,e)}}function lh(n){return n.version===0&&(n.compareFunction=Sd,n.needsUpdate=!0),n}function yw(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s);let r;this.type===n.SAMPLER_2D_SHADOW?r=lh(z_):r=k_,t.setTexture2D(e||r,s)}function bw(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s),t.setTexture3D(e||H_,s)}function Sw(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s);let r;this.type===n.SAMPLER_CUBE_SHADOW?r=lh(V_):r=W_,t.setTextureCube(e||r,s)}function Mw(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s),t.setTexture2DArray(e||G_,s)}function ww(n){switch(n){case 5126:return rw;case 35664:return ow;case 35665:return aw;case 35666:return lw;case 35674:return cw;case 35675:return uw;case 35676:return hw;case 5124:case 35670:return fw;case 35667:case 35671:return dw;case 35668:case 35672:return pw;case 35669:case 35673:return mw;case 5125:return gw;case 36294:return _w;case 36295:return vw;case 36296:return xw;case 35678:case 36198:case 36298:case 36306:case 35682:return yw;case 35679:case 36299:case 36307:return bw;case 35680:case 36300:case 36308:case 36293:return Sw;case 36289:case 36303:case 36311:case 36292:return Mw}}function Tw(n,e){n.uniform1fv(this.addr,e)}function Aw(n,e){let t=da(e,this.size,2);n.uniform2fv(this.addr,t)}function Ew(n,e){let t=da(e,this.size,3);n.uniform3fv(this.addr,t)}function Cw(n,e){let t=da(e,this.size,4);n.uniform4fv(this.addr,t)}function Rw(n,e){let t=da(e,this.size,4);n.uniformMatrix2fv(this.addr,!1,t)}function Pw(n,e){let t=da(e,this.size,9);n.uniformMatrix3fv(this.addr,!1,t)}function Iw(n,e){let t=da(e,this.size,16);n.uniformMatrix4fv(this.addr,!1,t)}function Lw(n,e){n.uniform1iv(this.addr,e)}function Dw(n,e){n.uniform2iv(this.addr,e)}function Nw(n,e){n.uniform3iv(this.addr,e)}function Uw(n,e){n.uniform4iv(this.addr,e)}function Ow(n,e){n.uniform1uiv(this.addr,e)}function Fw(n,e){n.uniform2uiv(this.addr,e)}function Bw(n,e){n.uniform3uiv(this.addr,e)}function kw(n,e){n.uniform4uiv(this.addr,e)}function zw(n,e,t){let i=this.cache,s=e.length,r=ah(t,s);Pn(i,r)||(n.uniform1iv(this.addr,r),In(i,r));let o;this.type===n.SAMPLER_2D_SHADOW?o=lh(z_):o=k_;for(let a=0;a!==s;++a)t.setTexture2D(e[a]||o,r[a])}function Vw(n,e,t){let i=this.cache,s=e.length,r=ah(t,s);Pn(i,r)||(n.uniform1iv(this.addr,r),In(i,r));for(let o=0;o!==s;++o)t.setTexture3D(e[o]||H_,r[o])}function Gw(n,e,t){let i=this.cache,s=e.length,r=ah(t,s);Pn(i,r)||(n.uniform1iv(this.addr,r),In(i,r));let o;this.type===n.SAMPLER_CUBE_SHADOW?o=lh(V_):o=W_;for(let a=0;a!==s;++a)t.setTextureCube(e[a]||o,r[a])}function Hw(n,e,t){let i=this.cache,s=e.length,r=ah(t,s);Pn(i,r)||(n.uniform1iv(this.addr,r),In(i,r));for(let o=0;o!==s;++o)t.setTexture2DArray(e[o]||G_,r[o])}function Ww(n){switch(n){case 5126:return Tw;case 35664:return Aw;case 35665:return Ew;case 35666:return Cw;case 35674:return Rw;case 35675:return Pw;case 35676:return Iw;case 5124:case 35670:return Lw;case 35667:case 35671:return Dw;case 35668:case 35672:return Nw;case 35669:case 35673:return Uw;case 5125:return Ow;case 36294:return Fw;case 36295:return Bw;case 36296:return kw;case 35678:case 36198:case 36298:case 36306:case 35682:return zw;case 35679:case 36299:case 36307:return Vw;case 35680:case 36300:case 36308:case 36293:return Gw;case 36289:case 36303:case 36311:case 36292:return Hw}}var Ud=class{constructor(e,t,i){this.id=e,this.addr=i,this.cache=[],this.type=t.type,this.setValue=ww(t.type)}},Od=class{constructor(e,t,i){this.id=e,this.addr=i,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=Ww(t.type)}},Fd=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,i){let s=this.seq;for(let r=0,o=s.length;r!==o;++r){let a=s[r];a.setValue(e,t[a.id],i)}}},Dd=/(\w+)(\])?(\[|\.)?/g;function M_(n,e){n.seq.push(e),n.map[e.id]=e}function Xw(n,e,t){let i=n.name,s=i.length;for(Dd.lastIndex=0;;){let r=Dd.exec(i),o=Dd.lastIndex,a=r[1],l=r[2]==="]",c=r[3];if(l&&(a=a|0),c===void 0||c==="["&&o+2===s){M_(t,c===void 0?new Ud(a,n,e):new Od(a,n,e));break}else{let h=t.map[a];h===void 0&&(h=new Fd(a),M_(t,h)),t=h}}}var fa=class{constructor(e,t){this.seq=[],this.map={};let i=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let o=0;o<i;++o){let a=e.getActiveUniform(t,o),l=e.getUniformLocation(t,a.name);Xw(a,l,this)}let s=[],r=[];for(let o of this.seq)o.type===e.SAMPLER_2D_SHADOW||o.type===e.SAMPLER_CUBE_SHADOW||o.type===e.SAMPLER_2D_ARRAY_SHADOW?s.push(o):r.push(o);s.length>0&&(this.seq=s.concat(r))}setValue(e,t,i,s){let r=this.map[t];r!==void 0&&r.setValue(e,i,s)}setOptional(e,t,i){let s=t[i];s!==void 0&&this.setValue(e,i,s)}static upload(e,t,i,s){for(let r=0,o=t.length;r!==o;++r){let a=t[r],l=i[a.id];l.needsUpdate!==!1&&a.setValue(e,l.value,s)}}static seqWithValue(e,t){let i=[];for(let s=0,r=e.length;s!==r;++s){let o=e[s];o.id in t&&i.push(o)}return i}};function w_(n,e,t){let i=n.createShader(e);return n.shaderSource(i,t),n.compileShader(i),i}var qw=37297,Yw=0;function $w(n,e){let t=n.split(`
`),i=[],s=Math.max(e-6,0),r=Math.min(e+6,t.length);for(let o=s;o<r;o++){let a=o+1;i.push(`${a===e?">":" "} ${a}: ${t[o]}`)}return i.join(`
`)}var T_=new nt;function Zw(n){_t._getMatrix(T_,_t.workingColorSpace,n);let e=`mat3( ${T_.elements.map(t=>t.toFixed(4))} )`;switch(_t.getTransfer(n)){case el:return[e,"LinearTransferOETF"];case Nt:return[e,"sRGBTransferOETF"];default:return Ye("WebGLProgram: Unsupported color space: ",n),[e,"LinearTransferOETF"]}}function A_(n,e,t){let i=n.getShaderParameter(e,n.COMPILE_STATUS),r=(n.getShaderInfoLog(e)||"").trim();if(i&&r==="")return"";let o=/ERROR: 0:(\d+)/.exec(r);if(o){let a=parseInt(o[1]);return t.toUpperCase()+`

`+r+`

`+$w(n.getShaderSource(e),a)}else return r}function Kw(n,e){let t=Zw(e);return[`vec4 ${n}( vec4 value ) {`,`	return ${t[1]}( vec4( ${t[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var Jw={[sd]:"Linear",[rd]:"Reinhard",[od]:"Cineon",[ad]:"ACESFilmic",[cd]:"AgX",[ud]:"Neutral",[ld]:"Custom"};function jw(n,e){let t=Jw[e];return t===void 0?(Ye("WebGLProgram: Unsupported toneMapping:",e),"vec3 "+n+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+n+"( vec3 color ) { return "+t+"ToneMapping( color ); }"}var sh=new V;function Qw(){_t.getLuminanceCoefficients(sh);let n=sh.x.toFixed(4),e=sh.y.toFixed(4),t=sh.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${n}, ${e}, ${t} );`,"	return dot( weights, rgb );","}"].join(`
`)}function e1(n){return[n.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",n.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(Tl).join(`
`)}function t1(n){let e=[];for(let t in n){let i=n[t];i!==!1&&e.push("#define "+t+" "+i)}return e.join(`
`)}function n1(n,e){let t={},i=n.getProgramParameter(e,n.ACTIVE_ATTRIBUTES);for(let s=0;s<i;s++){let r=n.getActiveAttrib(e,s),o=r.name,a=1;r.type===n.FLOAT_MAT2&&(a=2),r.type===n.FLOAT_MAT3&&(a=3),r.type===n.FLOAT_MAT4&&(a=4),t[o]={type:r.type,location:n.getAttribLocation(e,o),locationSize:a}}return t}function Tl(n){return n!==""}function E_(n,e){let t=e.numSpotLightShadows+e.numSpotLightMaps-e.numSpotLightShadowsWithMaps;return n.replace(/NUM_SUN_LIGHTS/g,e.numSunLights).replace(/NUM_DIR_LIGHTS/g,e.numDirLights).replace(/NUM_SPOT_LIGHTS/g,e.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,e.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,t).replace(/NUM_RECT_AREA_LIGHTS/g,e.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,e.numPointLights).replace(/NUM_HEMI_LIGHTS/g,e.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,e.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,e.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,e.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,e.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,e.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,e.numLightProbeGrids)}function C_(n,e){return n.replace(/NUM_CLIPPING_PLANES/g,e.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,e.numClippingPlanes-e.numClipIntersection)}var i1=/^[ \t]*#include +<([\w\d./]+)>/gm;function Bd(n){return n.replace(i1,s1)}function s1(n,e){let t=ft[e];if(t===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+e+">");return Bd(t)}var r1=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function R_(n){return n.replace(r1,o1)}function o1(n,e,t,i){let s="";for(let r=parseInt(e);r<parseInt(t);r++)s+=i.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function P_(n){let e=`precision ${n.precision} float;
	precision ${n.precision} int;
	precision ${n.precision} sampler2D;
	precision ${n.precision} samplerCube;
	precision ${n.precision} sampler3D;
	precision ${n.precision} sampler2DArray;
	precision ${n.precision} sampler2DShadow;
	precision ${n.precision} samplerCubeShadow;
	precision ${n.precision} sampler2DArrayShadow;
	precision ${n.precision} isampler2D;
	precision ${n.precision} isampler3D;
	precision ${n.precision} isamplerCube;
	precision ${n.precision} isampler2DArray;
	precision ${n.precision} usampler2D;
	precision ${n.precision} usampler3D;
	precision ${n.precision} usamplerCube;
	precision ${n.precision} usampler2DArray;
	`;return n.precision==="highp"?e+=`
#define HIGH_PRECISION`:n.precision==="mediump"?e+=`
#define MEDIUM_PRECISION`:n.precision==="lowp"&&(e+=`
#define LOW_PRECISION`),e}var a1={[gl]:"SHADOWMAP_TYPE_PCF",[aa]:"SHADOWMAP_TYPE_VSM"};function l1(n){return a1[n.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var c1={[ca]:"ENVMAP_MODE_REFRACTION"};function u1(n){return n.envMap===!1?"ENVMAP_MODE_REFLECTION":c1[n.envMapMode]||"ENVMAP_MODE_REFLECTION"}var h1={[id]:"ENVMAP_BLENDING_MULTIPLY",[qg]:"ENVMAP_BLENDING_MIX",[Yg]:"ENVMAP_BLENDING_ADD"};function f1(n){return n.envMap===!1?"ENVMAP_BLENDING_NONE":h1[n.combine]||"ENVMAP_BLENDING_NONE"}function d1(n,e,t,i){let s=n.getContext(),r=t.defines,o=t.vertexShader,a=t.fragmentShader,l=l1(t),c=t.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",u=u1(t),h=f1(t),f=e1(t),d=t1(r),g=s.createProgram(),y,p,m=t.glslVersion?"#version "+t.glslVersion+`
`:"";t.isRawShaderMaterial?(y=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,d].filter(Tl).join(`
`),y.length>0&&(y+=`
`),p=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,d].filter(Tl).join(`
`),p.length>0&&(p+=`
`)):(y=[P_(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,d,t.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",t.batching?"#define USE_BATCHING":"",t.batchingColor?"#define USE_BATCHING_COLOR":"",t.instancing?"#define USE_INSTANCING":"",t.instancingColor?"#define USE_INSTANCING_COLOR":"",t.instancingMorph?"#define USE_INSTANCING_MORPH":"",t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.map?"#define USE_MAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+u:"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.displacementMap?"#define USE_DISPLACEMENTMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.mapUv?"#define MAP_UV "+t.mapUv:"",t.alphaMapUv?"#define ALPHAMAP_UV "+t.alphaMapUv:"",t.lightMapUv?"#define LIGHTMAP_UV "+t.lightMapUv:"",t.aoMapUv?"#define AOMAP_UV "+t.aoMapUv:"",t.emissiveMapUv?"#define EMISSIVEMAP_UV "+t.emissiveMapUv:"",t.bumpMapUv?"#define BUMPMAP_UV "+t.bumpMapUv:"",t.normalMapUv?"#define NORMALMAP_UV "+t.normalMapUv:"",t.displacementMapUv?"#define DISPLACEMENTMAP_UV "+t.displacementMapUv:"",t.metalnessMapUv?"#define METALNESSMAP_UV "+t.metalnessMapUv:"",t.roughnessMapUv?"#define ROUGHNESSMAP_UV "+t.roughnessMapUv:"",t.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+t.anisotropyMapUv:"",t.clearcoatMapUv?"#define CLEARCOATMAP_UV "+t.clearcoatMapUv:"",t.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+t.clearcoatNormalMapUv:"",t.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+t.clearcoatRoughnessMapUv:"",t.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+t.diffuseRoughnessMapUv:"",t.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+t.iridescenceMapUv:"",t.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+t.iridescenceThicknessMapUv:"",t.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+t.sheenColorMapUv:"",t.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+t.sheenRoughnessMapUv:"",t.specularMapUv?"#define SPECULARMAP_UV "+t.specularMapUv:"",t.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+t.specularColorMapUv:"",t.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+t.specularIntensityMapUv:"",t.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+t.transmissionMapUv:"",t.thicknessMapUv?"#define THICKNESSMAP_UV "+t.thicknessMapUv:"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexNormals?"#define HAS_NORMAL":"",t.vertexColors?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.flatShading?"#define FLAT_SHADED":"",t.skinning?"#define USE_SKINNING":"",t.morphTargets?"#define USE_MORPHTARGETS":"",t.morphNormals&&t.flatShading===!1?"#define USE_MORPHNORMALS":"",t.morphColors?"#define USE_MORPHCOLORS":"",t.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+t.morphTextureStride:"",t.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+t.morphTargetsCount:"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.sizeAttenuation?"#define USE_SIZEATTENUATION":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(Tl).join(`
`),p=[P_(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,d,t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",t.map?"#define USE_MAP":"",t.matcap?"#define USE_MATCAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+c:"",t.envMap?"#define "+u:"",t.envMap?"#define "+h:"",t.envMapPMREM?"#define ENVMAP_MAX_LOD "+t.envMapMaxLod+".0":"",t.envMapPMREM?"#define ENVMAP_SIZE "+t.envMapSize+".0":"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoat?"#define USE_CLEARCOAT":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.dispersion?"#define USE_DISPERSION":"",t.retroreflection?"#define USE_RETROREFLECTION":"",t.iridescence?"#define USE_IRIDESCENCE":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaTest?"#define USE_ALPHATEST":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.sheen?"#define USE_SHEEN":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors||t.instancingColor?"#define USE_COLOR":"",t.vertexAlphas||t.batchingColor?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.gradientMap?"#define USE_GRADIENTMAP":"",t.flatShading?"#define FLAT_SHADED":"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",t.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",t.toneMapping!==ws?"#define TONE_MAPPING":"",t.toneMapping!==ws?ft.tonemapping_pars_fragment:"",t.toneMapping!==ws?jw("toneMapping",t.toneMapping):"",t.dithering?"#define DITHERING":"",t.opaque?"#define OPAQUE":"",ft.colorspace_pars_fragment,Kw("linearToOutputTexel",t.outputColorSpace),Qw(),t.useDepthPacking?"#define DEPTH_PACKING "+t.depthPacking:"",`
`].filter(Tl).join(`
`)),o=Bd(o),o=E_(o,t),o=C_(o,t),a=Bd(a),a=E_(a,t),a=C_(a,t),o=R_(o),a=R_(a),t.isRawShaderMaterial!==!0&&(m=`#version 300 es
`,y=[f,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+y,p=["#define varying in",t.glslVersion===Md?"":"layout(location = 0) out highp vec4 pc_fragColor;",t.glslVersion===Md?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+p);let x=m+y+o,R=m+p+a,S=w_(s,s.VERTEX_SHADER,x),C=w_(s,s.FRAGMENT_SHADER,R);s.attachShader(g,S),s.attachShader(g,C),t.index0AttributeName!==void 0?s.bindAttribLocation(g,0,t.index0AttributeName):t.hasPositionAttribute===!0&&s.bindAttribLocation(g,0,"position"),s.linkProgram(g);function E(N){if(n.debug.checkShaderErrors){let D=s.getProgramInfoLog(g)||"",W=s.getShaderInfoLog(S)||"",G=s.getShaderInfoLog(C)||"",U=D.trim(),X=W.trim(),K=G.trim(),H=!0,ce=!0;if(s.getProgramParameter(g,s.LINK_STATUS)===!1)if(H=!1,typeof n.debug.onShaderError=="function")n.debug.onShaderError(s,g,S,C);else{let J=A_(s,S,"vertex"),Q=A_(s,C,"fragment");Qe("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(g,s.VALIDATE_STATUS)+`

Material Name: `+N.name+`
Material Type: `+N.type+`

Program Info Log: `+U+`
`+J+`
`+Q)}else U!==""?Ye("WebGLProgram: Program Info Log:",U):(X===""||K==="")&&(ce=!1);ce&&(N.diagnostics={runnable:H,programLog:U,vertexShader:{log:X,prefix:y},fragmentShader:{log:K,prefix:p}})}s.deleteShader(S),s.deleteShader(C),v=new fa(s,g),T=n1(s,g)}let v;this.getUniforms=function(){return v===void 0&&E(this),v};let T;this.getAttributes=function(){return T===void 0&&E(this),T};let z=t.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return z===!1&&(z=s.getProgramParameter(g,qw)),z},this.destroy=function(){i.releaseStatesOfProgram(this),s.deleteProgram(g),this.program=void 0},this.type=t.shaderType,this.name=t.shaderName,this.id=Yw++,this.cacheKey=e,this.usedTimes=1,this.program=g,this.vertexShader=S,this.fragmentShader=C,this}var p1=0,kd=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,i){let s=this._getShaderCacheForMaterial(e);return s.has(t)===!1&&(s.add(t),t.usedTimes++),s.has(i)===!1&&(s.add(i),i.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let i of t)i.usedTimes--,i.usedTimes===0&&this.shaderCache.delete(i.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,i=t.get(e);return i===void 0&&(i=new Set,t.set(e,i)),i}_getShaderStage(e){let t=this.shaderCache,i=t.get(e);return i===void 0&&(i=new zd(e),t.set(e,i)),i}},zd=class{constructor(e){this.id=p1++,this.code=e,this.usedTimes=0}};function m1(n){return n===Rr||n===Sl||n===Ml}function g1(n,e,t,i,s,r){let o=new Qo,a=new kd,l=new Set,c=[],u=new Map,h=i.logarithmicDepthBuffer,f={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function d(v){return l.add(v),v===0?"uv":`uv${v}`}function g(v,T,z,N,D,W){let G=N.fog,U=D.geometry,X=v.isMeshStandardMaterial||v.isMeshLambertMaterial||v.isMeshPhongMaterial?N.environment:null,K=v.isMeshStandardMaterial||v.isMeshLambertMaterial&&!v.envMap||v.isMeshPhongMaterial&&!v.envMap,H=e.get(v.envMap||X,K),ce=f[v.type],J=i.precision;v.precision!==null&&(J=i.getMaxPrecision(v.precision),J!==v.precision&&Ye("WebGLProgram.getParameters:",v.precision,"not supported, using",J,"instead."));let Q=U.morphAttributes.position||U.morphAttributes.normal||U.morphAttributes.color,se=Q!==void 0?Q.length:0,fe=0;U.morphAttributes.position!==void 0&&(fe=1),U.morphAttributes.normal!==void 0&&(fe=2),U.morphAttributes.color!==void 0&&(fe=3);let he,ee,me,ve;if(ce){let Ce=As[ce];he=Ce.vertexShader,ee=Ce.fragmentShader}else{he=v.vertexShader,ee=v.fragmentShader;let Ce=a.getVertexShaderStage(v),ct=a.getFragmentShaderStage(v);a.update(v,Ce,ct),me=Ce.id,ve=ct.id}let Ee=n.getRenderTarget(),Se=n.state.buffers.depth.getReversed(),We=D.isInstancedMesh===!0,at=D.isBatchedMesh===!0,Ge=!!v.map,dt=!!v.matcap,ut=!!H,st=ut&&H.isPMREMTexture===!0,en=!!v.aoMap,Xt=!!v.lightMap,dn=!!v.bumpMap&&v.wireframe===!1,kt=!!v.normalMap,Un=!!v.displacementMap,At=!!v.emissiveMap,An=!!v.metalnessMap,on=!!v.roughnessMap,pn=v.anisotropy>0,F=v.clearcoat>0,Re=v.diffuseRoughness>0,$e=v.dispersion>0,lt=v.retroreflectivity>0,Me=v.iridescence>0,Gt=v.sheen>0,Ve=v.transmission>0,qe=pn&&!!v.anisotropyMap,P=F&&!!v.clearcoatMap,b=F&&!!v.clearcoatNormalMap,q=F&&!!v.clearcoatRoughnessMap,ue=Re&&!!v.diffuseRoughnessMap,oe=Me&&!!v.iridescenceMap,_e=Me&&!!v.iridescenceThicknessMap,xe=Gt&&!!v.sheenColorMap,te=Gt&&!!v.sheenRoughnessMap,ie=!!v.specularMap,pe=!!v.specularColorMap,O=!!v.specularIntensityMap,re=Ve&&!!v.transmissionMap,ne=Ve&&!!v.thicknessMap,we=!!v.gradientMap,ge=!!v.alphaMap,be=v.alphaTest>0,He=!!v.alphaHash,Je=!!v.extensions,le=ws;v.toneMapped&&(Ee===null||Ee.isXRRenderTarget===!0)&&(le=n.toneMapping);let Be=st?H.isCompressedCubeTexture?H.image[0].mipmaps:H.mipmaps:null,je={shaderID:ce,shaderType:v.type,shaderName:v.name,vertexShader:he,fragmentShader:ee,defines:v.defines,customVertexShaderID:me,customFragmentShaderID:ve,isRawShaderMaterial:v.isRawShaderMaterial===!0,glslVersion:v.glslVersion,precision:J,batching:at,batchingColor:at&&D._colorsTexture!==null,instancing:We,instancingColor:We&&D.instanceColor!==null,instancingMorph:We&&D.morphTexture!==null,outputColorSpace:Ee===null?n.outputColorSpace:Ee.isXRRenderTarget===!0?Ee.texture.colorSpace:_t.workingColorSpace,alphaToCoverage:!!v.alphaToCoverage,map:Ge,matcap:dt,envMap:ut,envMapMode:ut&&H.mapping,envMapPMREM:st,envMapMaxLod:st?Be.length-1:null,envMapSize:st?Be[0].width:null,aoMap:en,lightMap:Xt,bumpMap:dn,normalMap:kt,displacementMap:Un,emissiveMap:At,normalMapObjectSpace:kt&&v.normalMapType===Kg,normalMapTangentSpace:kt&&v.normalMapType===xd,packedNormalMap:kt&&v.normalMapType===xd&&m1(v.normalMap.format),metalnessMap:An,roughnessMap:on,anisotropy:pn,anisotropyMap:qe,clearcoat:F,clearcoatMap:P,clearcoatNormalMap:b,clearcoatRoughnessMap:q,diffuseRoughness:Re,diffuseRoughnessMap:ue,dispersion:$e,retroreflection:lt,iridescence:Me,iridescenceMap:oe,iridescenceThicknessMap:_e,sheen:Gt,sheenColorMap:xe,sheenRoughnessMap:te,specularMap:ie,specularColorMap:pe,specularIntensityMap:O,transmission:Ve,transmissionMap:re,thicknessMap:ne,gradientMap:we,opaque:v.transparent===!1&&v.blending===la&&v.alphaToCoverage===!1,alphaMap:ge,alphaTest:be,alphaHash:He,combine:v.combine,mapUv:Ge&&d(v.map.channel),aoMapUv:en&&d(v.aoMap.channel),lightMapUv:Xt&&d(v.lightMap.channel),bumpMapUv:dn&&d(v.bumpMap.channel),normalMapUv:kt&&d(v.normalMap.channel),displacementMapUv:Un&&d(v.displacementMap.channel),emissiveMapUv:At&&d(v.emissiveMap.channel),metalnessMapUv:An&&d(v.metalnessMap.channel),roughnessMapUv:on&&d(v.roughnessMap.channel),anisotropyMapUv:qe&&d(v.anisotropyMap.channel),clearcoatMapUv:P&&d(v.clearcoatMap.channel),clearcoatNormalMapUv:b&&d(v.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:q&&d(v.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:ue&&d(v.diffuseRoughnessMap.channel),iridescenceMapUv:oe&&d(v.iridescenceMap.channel),iridescenceThicknessMapUv:_e&&d(v.iridescenceThicknessMap.channel),sheenColorMapUv:xe&&d(v.sheenColorMap.channel),sheenRoughnessMapUv:te&&d(v.sheenRoughnessMap.channel),specularMapUv:ie&&d(v.specularMap.channel),specularColorMapUv:pe&&d(v.specularColorMap.channel),specularIntensityMapUv:O&&d(v.specularIntensityMap.channel),transmissionMapUv:re&&d(v.transmissionMap.channel),thicknessMapUv:ne&&d(v.thicknessMap.channel),alphaMapUv:ge&&d(v.alphaMap.channel),vertexTangents:!!U.attributes.tangent&&(kt||pn),vertexNormals:!!U.attributes.normal,vertexColors:v.vertexColors,vertexAlphas:v.vertexColors===!0&&!!U.attributes.color&&U.attributes.color.itemSize===4,pointsUvs:D.isPoints===!0&&!!U.attributes.uv&&(Ge||ge),fog:!!G,useFog:v.fog===!0,fogExp2:!!G&&G.isFogExp2,flatShading:v.wireframe===!1&&(v.flatShading===!0||U.attributes.normal===void 0&&kt===!1&&(v.isMeshLambertMaterial||v.isMeshPhongMaterial||v.isMeshStandardMaterial||v.isMeshPhysicalMaterial)),sizeAttenuation:v.sizeAttenuation===!0,logarithmicDepthBuffer:h,reversedDepthBuffer:Se,skinning:D.isSkinnedMesh===!0,hasPositionAttribute:U.attributes.position!==void 0,morphTargets:U.morphAttributes.position!==void 0,morphNormals:U.morphAttributes.normal!==void 0,morphColors:U.morphAttributes.color!==void 0,morphTargetsCount:se,morphTextureStride:fe,numSunLights:T.sun.length,numDirLights:T.directional.length,numPointLights:T.point.length,numSpotLights:T.spot.length,numSpotLightMaps:T.spotLightMap.length,numRectAreaLights:T.rectArea.length,numHemiLights:T.hemi.length,numSunLightShadows:T.sunShadowMap.length,numDirLightShadows:T.directionalShadowMap.length,numPointLightShadows:T.pointShadowMap.length,numSpotLightShadows:T.spotShadowMap.length,numSpotLightShadowsWithMaps:T.numSpotLightShadowsWithMaps,numLightProbes:T.numLightProbes,numLightProbeGrids:W.filter(Ce=>Ce.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:v.dithering,shadowMapEnabled:n.shadowMap.enabled&&z.length>0,shadowMapType:n.shadowMap.type,toneMapping:le,decodeVideoTexture:Ge&&v.map.isVideoTexture===!0&&_t.getTransfer(v.map.colorSpace)===Nt,decodeVideoTextureEmissive:At&&v.emissiveMap.isVideoTexture===!0&&_t.getTransfer(v.emissiveMap.colorSpace)===Nt,premultipliedAlpha:v.premultipliedAlpha,doubleSided:v.side===Ms,flipSided:v.side===pi,useDepthPacking:v.depthPacking>=0,depthPacking:v.depthPacking||0,index0AttributeName:v.index0AttributeName,extensionClipCullDistance:Je&&v.extensions.clipCullDistance===!0&&t.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(Je&&v.extensions.multiDraw===!0||at)&&t.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:t.has("KHR_parallel_shader_compile"),customProgramCacheKey:v.customProgramCacheKey()};return je.vertexUv1s=l.has(1),je.vertexUv2s=l.has(2),je.vertexUv3s=l.has(3),l.clear(),je}function y(v){let T=[];if(v.shaderID?T.push(v.shaderID):(T.push(v.customVertexShaderID),T.push(v.customFragmentShaderID)),v.defines!==void 0)for(let z in v.defines)T.push(z),T.push(v.defines[z]);return v.isRawShaderMaterial===!1&&(p(T,v),m(T,v),T.push(n.outputColorSpace)),T.push(v.customProgramCacheKey),T.join()}function p(v,T){v.push(T.precision),v.push(T.outputColorSpace),v.push(T.envMapMode),v.push(T.envMapPMREM),v.push(T.envMapMaxLod),v.push(T.envMapSize),v.push(T.mapUv),v.push(T.alphaMapUv),v.push(T.lightMapUv),v.push(T.aoMapUv),v.push(T.bumpMapUv),v.push(T.normalMapUv),v.push(T.displacementMapUv),v.push(T.emissiveMapUv),v.push(T.metalnessMapUv),v.push(T.roughnessMapUv),v.push(T.anisotropyMapUv),v.push(T.clearcoatMapUv),v.push(T.clearcoatNormalMapUv),v.push(T.clearcoatRoughnessMapUv),v.push(T.diffuseRoughnessMapUv),v.push(T.iridescenceMapUv),v.push(T.iridescenceThicknessMapUv),v.push(T.sheenColorMapUv),v.push(T.sheenRoughnessMapUv),v.push(T.specularMapUv),v.push(T.specularColorMapUv),v.push(T.specularIntensityMapUv),v.push(T.transmissionMapUv),v.push(T.thicknessMapUv),v.push(T.combine),v.push(T.fogExp2),v.push(T.sizeAttenuation),v.push(T.morphTargetsCount),v.push(T.numSunLights),v.push(T.numDirLights),v.push(T.numPointLights),v.push(T.numSpotLights),v.push(T.numSpotLightMaps),v.push(T.numHemiLights),v.push(T.numRectAreaLights),v.push(T.numSunLightShadows),v.push(T.numDirLightShadows),v.push(T.numPointLightShadows),v.push(T.numSpotLightShadows),v.push(T.numSpotLightShadowsWithMaps),v.push(T.numLightProbes),v.push(T.numLightProbeGrids),v.push(T.shadowMapType),v.push(T.toneMapping),v.push(T.numClippingPlanes),v.push(T.numClipIntersection),v.push(T.depthPacking)}function m(v,T){o.disableAll(),T.instancing&&o.enable(0),T.instancingColor&&o.enable(1),T.instancingMorph&&o.enable(2),T.matcap&&o.enable(3),T.envMap&&o.enable(4),T.normalMapObjectSpace&&o.enable(5),T.normalMapTangentSpace&&o.enable(6),T.clearcoat&&o.enable(7),T.iridescence&&o.enable(8),T.alphaTest&&o.enable(9),T.vertexColors&&o.enable(10),T.vertexAlphas&&o.enable(11),T.vertexUv1s&&o.enable(12),T.vertexUv2s&&o.enable(13),T.vertexUv3s&&o.enable(14),T.vertexTangents&&o.enable(15),T.anisotropy&&o.enable(16),T.alphaHash&&o.enable(17),T.batching&&o.enable(18),T.dispersion&&o.enable(19),T.retroreflection&&o.enable(24),T.diffuseRoughness&&o.enable(25),T.batchingColor&&o.enable(20),T.gradientMap&&o.enable(21),T.packedNormalMap&&o.enable(22),T.vertexNormals&&o.enable(23),v.push(o.mask),o.disableAll(),T.fog&&o.enable(0),T.useFog&&o.enable(1),T.flatShading&&o.enable(2),T.logarithmicDepthBuffer&&o.enable(3),T.reversedDepthBuffer&&o.enable(4),T.skinning&&o.enable(5),T.morphTargets&&o.enable(6),T.morphNormals&&o.enable(7),T.morphColors&&o.enable(8),T.premultipliedAlpha&&o.enable(9),T.shadowMapEnabled&&o.enable(10),T.doubleSided&&o.enable(11),T.flipSided&&o.enable(12),T.useDepthPacking&&o.enable(13),T.dithering&&o.enable(14),T.transmission&&o.enable(15),T.sheen&&o.enable(16),T.opaque&&o.enable(17),T.pointsUvs&&o.enable(18),T.decodeVideoTexture&&o.enable(19),T.decodeVideoTextureEmissive&&o.enable(20),T.alphaToCoverage&&o.enable(21),T.numLightProbeGrids>0&&o.enable(22),T.hasPositionAttribute&&o.enable(23),v.push(o.mask)}function x(v){let T=f[v.type],z;if(T){let N=As[T];z=h_.clone(N.uniforms)}else z=v.uniforms;return z}function R(v,T){let z=u.get(T);return z!==void 0?++z.usedTimes:(z=new d1(n,T,v,s),c.push(z),u.set(T,z)),z}function S(v){if(--v.usedTimes===0){let T=c.indexOf(v);c[T]=c[c.length-1],c.pop(),u.delete(v.cacheKey),v.destroy()}}function C(v){a.remove(v)}function E(){a.dispose()}return{getParameters:g,getProgramCacheKey:y,getUniforms:x,acquireProgram:R,releaseProgram:S,releaseShaderCache:C,programs:c,dispose:E}}function _1(){let n=new WeakMap;function e(o){return n.has(o)}function t(o){let a=n.get(o);return a===void 0&&(a={},n.set(o,a)),a}function i(o){n.delete(o)}function s(o,a,l){n.get(o)[a]=l}function r(){n=new WeakMap}return{has:e,get:t,remove:i,update:s,dispose:r}}function v1(n,e){return n.groupOrder!==e.groupOrder?n.groupOrder-e.groupOrder:n.renderOrder!==e.renderOrder?n.renderOrder-e.renderOrder:n.material.id!==e.material.id?n.material.id-e.material.id:n.materialVariant!==e.materialVariant?n.materialVariant-e.materialVariant:n.z!==e.z?n.z-e.z:n.id-e.id}function I_(n,e){return n.groupOrder!==e.groupOrder?n.groupOrder-e.groupOrder:n.renderOrder!==e.renderOrder?n.renderOrder-e.renderOrder:n.z!==e.z?e.z-n.z:n.id-e.id}function L_(){let n=[],e=0,t=[],i=[],s=[];function r(){e=0,t.length=0,i.length=0,s.length=0}function o(f){let d=0;return f.isInstancedMesh&&(d+=2),f.isSkinnedMesh&&(d+=1),d}function a(f,d,g,y,p,m){let x=n[e];return x===void 0?(x={id:f.id,object:f,geometry:d,material:g,materialVariant:o(f),groupOrder:y,renderOrder:f.renderOrder,z:p,group:m},n[e]=x):(x.id=f.id,x.object=f,x.geometry=d,x.material=g,x.materialVariant=o(f),x.groupOrder=y,x.renderOrder=f.renderOrder,x.z=p,x.group=m),e++,x}function l(f,d,g,y,p,m,x){x.reversedDepth===!0&&(p=-p);let R=a(f,d,g,y,p,m);g.transmission>0?i.push(R):g.transparent===!0?s.push(R):t.push(R)}function c(f,d,g,y,p,m){let x=a(f,d,g,y,p,m);g.transmission>0?i.unshift(x):g.transparent===!0?s.unshift(x):t.unshift(x)}function u(f,d){t.length>1&&t.sort(f||v1),i.length>1&&i.sort(d||I_),s.length>1&&s.sort(d||I_)}function h(){for(let f=e,d=n.length;f<d;f++){let g=n[f];if(g.id===null)break;g.id=null,g.object=null,g.geometry=null,g.material=null,g.group=null}}return{opaque:t,transmissive:i,transparent:s,init:r,push:l,unshift:c,finish:h,sort:u}}function x1(){let n=new WeakMap;function e(i,s){let r=n.get(i),o;return r===void 0?(o=new L_,n.set(i,[o])):s>=r.length?(o=new L_,r.push(o)):o=r[s],o}function t(){n=new WeakMap}return{get:e,dispose:t}}function y1(){let n={};return{get:function(e){if(n[e.id]!==void 0)return n[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={direction:new V,color:new yt};break;case"SpotLight":t={position:new V,direction:new V,color:new yt,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":t={position:new V,color:new yt,distance:0,decay:0};break;case"HemisphereLight":t={direction:new V,skyColor:new yt,groundColor:new yt};break;case"RectAreaLight":t={color:new yt,position:new V,halfWidth:new V,halfHeight:new V};break}return n[e.id]=t,t}}}function b1(){let n={};return{get:function(e){if(n[e.id]!==void 0)return n[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new tt};break;case"SpotLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new tt};break;case"PointLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new tt,shadowCameraNear:1,shadowCameraFar:1e3};break}return n[e.id]=t,t}}}var S1=0;function M1(n,e){return(e.castShadow?2:0)-(n.castShadow?2:0)+(e.map?1:0)-(n.map?1:0)}function w1(n){let e=new y1,t=b1(),i={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)i.probe.push(new V);let s=new V,r=new Mt,o=new Mt;function a(c){let u=0,h=0,f=0;for(let W=0;W<9;W++)i.probe[W].set(0,0,0);let d=0,g=0,y=0,p=0,m=0,x=0,R=0,S=0,C=0,E=0,v=0,T=0,z=0,N=0;c.sort(M1);for(let W=0,G=c.length;W<G;W++){let U=c[W],X=U.color,K=U.intensity,H=U.distance,ce=null;if(U.shadow&&U.shadow.map&&(U.shadow.map.texture.format===Rr?ce=U.shadow.map.texture:ce=U.shadow.map.depthTexture||U.shadow.map.texture),U.isAmbientLight)u+=X.r*K,h+=X.g*K,f+=X.b*K;else if(U.isLightProbe){for(let J=0;J<9;J++)i.probe[J].addScaledVector(U.sh.coefficients[J],K);N++}else if(U.isSunLight){let J=e.get(U);if(J.color.copy(U.color).multiplyScalar(U.intensity),U.castShadow){let Q=U.shadow,se=t.get(U);se.shadowIntensity=Q.intensity,se.shadowBias=Q.bias,se.shadowNormalBias=Q.normalBias,se.shadowRadius=Q.radius,se.shadowMapSize.copy(Q.mapSize).multiply(Q.getFrameExtents()),i.sunShadow[g]=se,i.sunShadowMap[g]=ce;let fe=Q.getViewportCount();for(let he=0;he<fe;he++)i.sunShadowMatrix[y+he]=Q.getMatrix(he),i.sunShadowCascade[y+he]=Q._cascadeData[he];y+=fe,g++}i.sun[d]=J,d++}else if(U.isDirectionalLight){let J=e.get(U);if(J.color.copy(U.color).multiplyScalar(U.intensity),U.castShadow){let Q=U.shadow,se=t.get(U);se.shadowIntensity=Q.intensity,se.shadowBias=Q.bias,se.shadowNormalBias=Q.normalBias,se.shadowRadius=Q.radius,se.shadowMapSize=Q.mapSize,i.directionalShadow[p]=se,i.directionalShadowMap[p]=ce,i.directionalShadowMatrix[p]=U.shadow.matrix,C++}i.directional[p]=J,p++}else if(U.isSpotLight){let J=e.get(U);J.position.setFromMatrixPosition(U.matrixWorld),J.color.copy(X).multiplyScalar(K),J.distance=H,J.coneCos=Math.cos(U.angle),J.penumbraCos=Math.cos(U.angle*(1-U.penumbra)),J.decay=U.decay,i.spot[x]=J;let Q=U.shadow;if(U.map&&(i.spotLightMap[T]=U.map,T++,Q.updateMatrices(U),U.castShadow&&z++),i.spotLightMatrix[x]=Q.matrix,U.castShadow){let se=t.get(U);se.shadowIntensity=Q.intensity,se.shadowBias=Q.bias,se.shadowNormalBias=Q.normalBias,se.shadowRadius=Q.radius,se.shadowMapSize=Q.mapSize,i.spotShadow[x]=se,i.spotShadowMap[x]=ce,v++}x++}else if(U.isRectAreaLight){let J=e.get(U);J.color.copy(X).multiplyScalar(K),J.halfWidth.set(U.width*.5,0,0),J.halfHeight.set(0,U.height*.5,0),i.rectArea[R]=J,R++}else if(U.isPointLight){let J=e.get(U);if(J.color.copy(U.color).multiplyScalar(U.intensity),J.distance=U.distance,J.decay=U.decay,U.castShadow){let Q=U.shadow,se=t.get(U);se.shadowIntensity=Q.intensity,se.shadowBias=Q.bias,se.shadowNormalBias=Q.normalBias,se.shadowRadius=Q.radius,se.shadowMapSize=Q.mapSize,se.shadowCameraNear=Q.camera.near,se.shadowCameraFar=Q.camera.far,i.pointShadow[m]=se,i.pointShadowMap[m]=ce,i.pointShadowMatrix[m]=U.shadow.matrix,E++}i.point[m]=J,m++}else if(U.isHemisphereLight){let J=e.get(U);J.skyColor.copy(U.color).multiplyScalar(K),J.groundColor.copy(U.groundColor).multiplyScalar(K),i.hemi[S]=J,S++}}R>0&&(n.has("OES_texture_float_linear")===!0?(i.rectAreaLTC1=Le.LTC_FLOAT_1,i.rectAreaLTC2=Le.LTC_FLOAT_2):(i.rectAreaLTC1=Le.LTC_HALF_1,i.rectAreaLTC2=Le.LTC_HALF_2)),i.ambient[0]=u,i.ambient[1]=h,i.ambient[2]=f;let D=i.hash;(D.sunLength!==d||D.directionalLength!==p||D.pointLength!==m||D.spotLength!==x||D.rectAreaLength!==R||D.hemiLength!==S||D.numSunShadows!==g||D.numDirectionalShadows!==C||D.numPointShadows!==E||D.numSpotShadows!==v||D.numSpotMaps!==T||D.numLightProbes!==N)&&(i.sun.length=d,i.directional.length=p,i.spot.length=x,i.rectArea.length=R,i.point.length=m,i.hemi.length=S,i.sunShadow.length=g,i.sunShadowMap.length=g,i.sunShadowMatrix.length=y,i.sunShadowCascade.length=y,i.directionalShadow.length=C,i.directionalShadowMap.length=C,i.directionalShadowMatrix.length=C,i.pointShadow.length=E,i.pointShadowMap.length=E,i.pointShadowMatrix.length=E,i.spotShadow.length=v,i.spotShadowMap.length=v,i.spotLightMatrix.length=v+T-z,i.spotLightMap.length=T,i.numSpotLightShadowsWithMaps=z,i.numLightProbes=N,D.sunLength=d,D.directionalLength=p,D.pointLength=m,D.spotLength=x,D.rectAreaLength=R,D.hemiLength=S,D.numSunShadows=g,D.numDirectionalShadows=C,D.numPointShadows=E,D.numSpotShadows=v,D.numSpotMaps=T,D.numLightProbes=N,i.version=S1++)}function l(c,u){let h=0,f=0,d=0,g=0,y=0,p=0,m=u.matrixWorldInverse;for(let x=0,R=c.length;x<R;x++){let S=c[x];if(S.isSunLight){let C=i.sun[h];C.direction.setFromMatrixPosition(S.matrixWorld),C.direction.transformDirection(m),h++}else if(S.isDirectionalLight){let C=i.directional[f];C.direction.setFromMatrixPosition(S.matrixWorld),s.setFromMatrixPosition(S.target.matrixWorld),C.direction.sub(s),C.direction.transformDirection(m),f++}else if(S.isSpotLight){let C=i.spot[g];C.position.setFromMatrixPosition(S.matrixWorld),C.position.applyMatrix4(m),C.direction.setFromMatrixPosition(S.matrixWorld),s.setFromMatrixPosition(S.target.matrixWorld),C.direction.sub(s),C.direction.transformDirection(m),g++}else if(S.isRectAreaLight){let C=i.rectArea[y];C.position.setFromMatrixPosition(S.matrixWorld),C.position.applyMatrix4(m),o.identity(),r.copy(S.matrixWorld),r.premultiply(m),o.extractRotation(r),C.halfWidth.set(S.width*.5,0,0),C.halfHeight.set(0,S.height*.5,0),C.halfWidth.applyMatrix4(o),C.halfHeight.applyMatrix4(o),y++}else if(S.isPointLight){let C=i.point[d];C.position.setFromMatrixPosition(S.matrixWorld),C.position.applyMatrix4(m),d++}else if(S.isHemisphereLight){let C=i.hemi[p];C.direction.setFromMatrixPosition(S.matrixWorld),C.direction.transformDirection(m),p++}}}return{setup:a,setupView:l,state:i}}function D_(n){let e=new w1(n),t=[],i=[],s=[];function r(h){u.camera=h,t.length=0,i.length=0,s.length=0}function o(h){h.isLightProbeGrid?s.push(h):t.push(h)}function a(h){i.push(h)}function l(){e.setup(t),s.sort((h,f)=>h.priority-f.priority||h.id-f.id)}function c(h){e.setupView(t,h)}let u={lightsArray:t,shadowsArray:i,lightProbeGridArray:s,camera:null,lights:e,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:u,setupLights:l,setupLightsView:c,pushLight:o,pushShadow:a}}function T1(n){let e=new WeakMap;function t(s,r=0){let o=e.get(s),a;return o===void 0?(a=new D_(n),e.set(s,[a])):r>=o.length?(a=new D_(n),o.push(a)):a=o[r],a}function i(){e=new WeakMap}return{get:t,dispose:i}}var A1=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,E1=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,C1=[new V(1,0,0),new V(-1,0,0),new V(0,1,0),new V(0,-1,0),new V(0,0,1),new V(0,0,-1)],R1=[new V(0,-1,0),new V(0,-1,0),new V(0,0,1),new V(0,0,-1),new V(0,-1,0),new V(0,-1,0)],N_=new Mt,wl=new V,Nd=new V;function P1(n,e,t){let i=new Kr,s=new tt,r=new tt,o=new rn,a=new ru,l=new ou,c={},u=t.maxTextureSize,h={[Cr]:pi,[pi]:Cr,[Ms]:Ms},f=new Vi({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new tt},radius:{value:4}},vertexShader:A1,fragmentShader:E1}),d=f.clone();d.defines.HORIZONTAL_PASS=1;let g=new Gn;g.setAttribute("position",new Sn(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let y=new zi(g,f),p=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=gl;let m=this.type;this.render=function(E,v,T){if(p.enabled===!1||p.autoUpdate===!1&&p.needsUpdate===!1||E.length===0)return;this.type===Eg&&(Ye("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=gl);let z=n.getRenderTarget(),N=n.getActiveCubeFace(),D=n.getActiveMipmapLevel(),W=n.state;W.setBlending(Jr),W.buffers.depth.getReversed()===!0?W.buffers.color.setClear(0,0,0,0):W.buffers.color.setClear(1,1,1,1),W.buffers.depth.setTest(!0),W.setScissorTest(!1);let G=m!==this.type;G&&v.traverse(function(U){U.material&&(Array.isArray(U.material)?U.material.forEach(X=>X.needsUpdate=!0):U.material.needsUpdate=!0)});for(let U=0,X=E.length;U<X;U++){let K=E[U],H=K.shadow;if(H===void 0){Ye("WebGLShadowMap:",K,"has no shadow.");continue}if(H.autoUpdate===!1&&H.needsUpdate===!1)continue;s.copy(H.mapSize);let ce=H.getFrameExtents();s.multiply(ce),r.copy(H.mapSize),(s.x>u||s.y>u)&&(s.x>u&&(r.x=Math.floor(u/ce.x),s.x=r.x*ce.x,H.mapSize.x=r.x),s.y>u&&(r.y=Math.floor(u/ce.y),s.y=r.y*ce.y,H.mapSize.y=r.y));let J=n.state.buffers.depth.getReversed();if(H.camera._reversedDepth=J,H.map===null||G===!0){if(H.map!==null&&(H.map.depthTexture!==null&&(H.map.depthTexture.dispose(),H.map.depthTexture=null),H.map.dispose()),this.type===aa){if(K.isPointLight){Ye("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}H.map=new Ri(s.x,s.y,{format:Rr,type:rs,minFilter:fi,magFilter:fi,generateMipmaps:!1}),H.map.texture.name=K.name+".shadowMap",H.map.depthTexture=new Zs(s.x,s.y,ss),H.map.depthTexture.name=K.name+".shadowMapDepth",H.map.depthTexture.format=Xs,H.map.depthTexture.compareFunction=null,H.map.depthTexture.minFilter=Vn,H.map.depthTexture.magFilter=Vn}else K.isPointLight?(H.map=new Al(s.x),H.map.depthTexture=new ll(s.x,is)):(H.map=new Ri(s.x,s.y),H.map.depthTexture=new Zs(s.x,s.y,is)),H.map.depthTexture.name=K.name+".shadowMap",H.map.depthTexture.format=Xs,this.type===gl?(H.map.depthTexture.compareFunction=J?bd:yd,H.map.depthTexture.minFilter=fi,H.map.depthTexture.magFilter=fi):(H.map.depthTexture.compareFunction=null,H.map.depthTexture.minFilter=Vn,H.map.depthTexture.magFilter=Vn);H.camera.updateProjectionMatrix()}H.map.isWebGLCubeRenderTarget!==!0&&(H.map.width!==s.x||H.map.height!==s.y)&&H.map.setSize(s.x,s.y);let Q=H.map.isWebGLCubeRenderTarget?6:H.getViewportCount();K.isPointLight!==!0&&H.updateMatrices(K,T);let se=(H.camera.layers.mask&4294967294)!==0?H.camera.layers:T.layers;for(let fe=0;fe<Q;fe++){let he=H.getCamera(fe);if(K.isPointLight){let ee=H.camera,me=H.matrix,ve=K.distance||ee.far;ve!==ee.far&&(ee.far=ve,ee.updateProjectionMatrix()),wl.setFromMatrixPosition(K.matrixWorld),ee.position.copy(wl),Nd.copy(ee.position),Nd.add(C1[fe]),ee.up.copy(R1[fe]),ee.lookAt(Nd),ee.updateMatrixWorld(),me.makeTranslation(-wl.x,-wl.y,-wl.z),N_.multiplyMatrices(ee.projectionMatrix,ee.matrixWorldInverse),H._frustum.setFromProjectionMatrix(N_,ee.coordinateSystem,ee.reversedDepth)}if(H.map.isWebGLCubeRenderTarget)n.setRenderTarget(H.map,fe),n.clear();else{fe===0&&(n.setRenderTarget(H.map),n.clear());let ee=H.getViewport(fe);o.set(r.x*ee.x,r.y*ee.y,r.x*ee.z,r.y*ee.w),W.viewport(o)}i=H.getFrustum(fe),S(v,T,he,K,se,this.type)}H.isPointLightShadow!==!0&&this.type===aa&&x(H,T),H.needsUpdate=!1}m=this.type,p.needsUpdate=!1,n.setRenderTarget(z,N,D)};function x(E,v){let T=e.update(y);f.defines.VSM_SAMPLES!==E.blurSamples&&(f.defines.VSM_SAMPLES=E.blurSamples,d.defines.VSM_SAMPLES=E.blurSamples,f.needsUpdate=!0,d.needsUpdate=!0),E.mapPass===null?E.mapPass=new Ri(s.x,s.y,{format:Rr,type:rs}):(E.mapPass.width!==E.map.width||E.mapPass.height!==E.map.height)&&E.mapPass.setSize(E.map.width,E.map.height),f.uniforms.shadow_pass.value=E.map.depthTexture,f.uniforms.resolution.value.set(E.map.width,E.map.height),f.uniforms.radius.value=E.radius,n.setRenderTarget(E.mapPass),n.clear(),n.renderBufferDirect(v,null,T,f,y,null),d.uniforms.shadow_pass.value=E.mapPass.texture,d.uniforms.resolution.value.set(E.map.width,E.map.height),d.uniforms.radius.value=E.radius,n.setRenderTarget(E.map),n.clear(),n.renderBufferDirect(v,null,T,d,y,null)}function R(E,v,T,z){let N=null,D=T.isPointLight===!0?E.customDistanceMaterial:E.customDepthMaterial;if(D!==void 0)N=D;else if(N=T.isPointLight===!0?l:a,n.localClippingEnabled&&v.clipShadows===!0&&Array.isArray(v.clippingPlanes)&&v.clippingPlanes.length!==0||v.displacementMap&&v.displacementScale!==0||v.alphaMap&&v.alphaTest>0||v.map&&v.alphaTest>0||v.alphaToCoverage===!0){let W=N.uuid,G=v.uuid,U=c[W];U===void 0&&(U={},c[W]=U);let X=U[G];X===void 0&&(X=N.clone(),U[G]=X,v.addEventListener("dispose",C)),N=X}if(N.visible=v.visible,N.wireframe=v.wireframe,z===aa?N.side=v.shadowSide!==null?v.shadowSide:v.side:N.side=v.shadowSide!==null?v.shadowSide:h[v.side],N.alphaMap=v.alphaMap,N.alphaTest=v.alphaToCoverage===!0?.5:v.alphaTest,N.map=v.map,N.clipShadows=v.clipShadows,N.clippingPlanes=v.clippingPlanes,N.clipIntersection=v.clipIntersection,N.displacementMap=v.displacementMap,N.displacementScale=v.displacementScale,N.displacementBias=v.displacementBias,N.wireframeLinewidth=v.wireframeLinewidth,N.linewidth=v.linewidth,T.isPointLight===!0&&N.isMeshDistanceMaterial===!0){let W=n.properties.get(N);W.light=T}return N}function S(E,v,T,z,N,D){if(E.visible===!1)return;if(E.layers.test(N)&&(E.isMesh||E.isLine||E.isPoints)&&(E.castShadow||E.receiveShadow&&D===aa)&&(!E.frustumCulled||E.intersectsFrustum(i))){E.modelViewMatrix.multiplyMatrices(T.matrixWorldInverse,E.matrixWorld);let U=e.update(E),X=E.material;if(Array.isArray(X)){let K=U.groups;for(let H=0,ce=K.length;H<ce;H++){let J=K[H],Q=X[J.materialIndex];if(Q&&Q.visible){let se=R(E,Q,z,D);E.onBeforeShadow(n,E,v,T,U,se,J),n.renderBufferDirect(T,null,U,se,E,J),E.onAfterShadow(n,E,v,T,U,se,J)}}}else if(X.visible){let K=R(E,X,z,D);E.onBeforeShadow(n,E,v,T,U,K,null),n.renderBufferDirect(T,null,U,K,E,null),E.onAfterShadow(n,E,v,T,U,K,null)}}let G=E.children;for(let U=0,X=G.length;U<X;U++)S(G[U],v,T,z,N,D)}function C(E){E.target.removeEventListener("dispose",C);for(let T in c){let z=c[T],N=E.target.uuid;N in z&&(z[N].dispose(),delete z[N])}}}function I1(n,e){function t(){let O=!1,re=new rn,ne=null,we=new rn(0,0,0,0);return{setMask:function(ge){ne!==ge&&!O&&(n.colorMask(ge,ge,ge,ge),ne=ge)},setLocked:function(ge){O=ge},setClear:function(ge,be,He,Je,le){le===!0&&(ge*=Je,be*=Je,He*=Je),re.set(ge,be,He,Je),we.equals(re)===!1&&(n.clearColor(ge,be,He,Je),we.copy(re))},reset:function(){O=!1,ne=null,we.set(-1,0,0,0)}}}function i(){let O=!1,re=!1,ne=null,we=null,ge=null;return{setReversed:function(be){if(re!==be){let He=e.get("EXT_clip_control");be?He.clipControlEXT(He.LOWER_LEFT_EXT,He.ZERO_TO_ONE_EXT):He.clipControlEXT(He.LOWER_LEFT_EXT,He.NEGATIVE_ONE_TO_ONE_EXT),re=be;let Je=ge;ge=null,this.setClear(Je)}},getReversed:function(){return re},setTest:function(be){be?Se(n.DEPTH_TEST):We(n.DEPTH_TEST)},setMask:function(be){ne!==be&&!O&&(n.depthMask(be),ne=be)},setFunc:function(be){if(re&&(be=a_[be]),we!==be){switch(be){case zc:n.depthFunc(n.NEVER);break;case Vc:n.depthFunc(n.ALWAYS);break;case Gc:n.depthFunc(n.LESS);break;case Zo:n.depthFunc(n.LEQUAL);break;case Hc:n.depthFunc(n.EQUAL);break;case Wc:n.depthFunc(n.GEQUAL);break;case Xc:n.depthFunc(n.GREATER);break;case qc:n.depthFunc(n.NOTEQUAL);break;default:n.depthFunc(n.LEQUAL)}we=be}},setLocked:function(be){O=be},setClear:function(be){ge!==be&&(ge=be,re&&(be=1-be),n.clearDepth(be))},reset:function(){O=!1,ne=null,we=null,ge=null,re=!1}}}function s(){let O=!1,re=null,ne=null,we=null,ge=null,be=null,He=null,Je=null,le=null;return{setTest:function(Be){O||(Be?Se(n.STENCIL_TEST):We(n.STENCIL_TEST))},setMask:function(Be){re!==Be&&!O&&(n.stencilMask(Be),re=Be)},setFunc:function(Be,je,Ce){(ne!==Be||we!==je||ge!==Ce)&&(n.stencilFunc(Be,je,Ce),ne=Be,we=je,ge=Ce)},setOp:function(Be,je,Ce){(be!==Be||He!==je||Je!==Ce)&&(n.stencilOp(Be,je,Ce),be=Be,He=je,Je=Ce)},setLocked:function(Be){O=Be},setClear:function(Be){le!==Be&&(n.clearStencil(Be),le=Be)},reset:function(){O=!1,re=null,ne=null,we=null,ge=null,be=null,He=null,Je=null,le=null}}}let r=new t,o=new i,a=new s,l={},c=new WeakMap,u={},h={},f={},d=new WeakMap,g=[],y=null,p=!1,m=null,x=null,R=null,S=null,C=null,E=null,v=null,T=new yt(0,0,0),z=0,N=!1,D=null,W=null,G=null,U=null,X=null,K=n.getParameter(n.MAX_COMBINED_TEXTURE_IMAGE_UNITS),H=!1,ce=0,J=n.getParameter(n.VERSION);J.indexOf("WebGL")!==-1?(ce=parseFloat(/^WebGL (\d)/.exec(J)[1]),H=ce>=1):J.indexOf("OpenGL ES")!==-1&&(ce=parseFloat(/^OpenGL ES (\d)/.exec(J)[1]),H=ce>=2);let Q=null,se={},fe=n.getParameter(n.SCISSOR_BOX),he=n.getParameter(n.VIEWPORT),ee=new rn().fromArray(fe),me=new rn().fromArray(he);function ve(O,re,ne,we){let ge=new Uint8Array(4),be=n.createTexture();n.bindTexture(O,be),n.texParameteri(O,n.TEXTURE_MIN_FILTER,n.NEAREST),n.texParameteri(O,n.TEXTURE_MAG_FILTER,n.NEAREST);for(let He=0;He<ne;He++)O===n.TEXTURE_3D||O===n.TEXTURE_2D_ARRAY?n.texImage3D(re,0,n.RGBA,1,1,we,0,n.RGBA,n.UNSIGNED_BYTE,ge):n.texImage2D(re+He,0,n.RGBA,1,1,0,n.RGBA,n.UNSIGNED_BYTE,ge);return be}let Ee={};Ee[n.TEXTURE_2D]=ve(n.TEXTURE_2D,n.TEXTURE_2D,1),Ee[n.TEXTURE_CUBE_MAP]=ve(n.TEXTURE_CUBE_MAP,n.TEXTURE_CUBE_MAP_POSITIVE_X,6),Ee[n.TEXTURE_2D_ARRAY]=ve(n.TEXTURE_2D_ARRAY,n.TEXTURE_2D_ARRAY,1,1),Ee[n.TEXTURE_3D]=ve(n.TEXTURE_3D,n.TEXTURE_3D,1,1),r.setClear(0,0,0,1),o.setClear(1),a.setClear(0),Se(n.DEPTH_TEST),o.setFunc(Zo),dn(!1),kt(Jf),Se(n.CULL_FACE),en(Jr);function Se(O){u[O]!==!0&&(n.enable(O),u[O]=!0)}function We(O){u[O]!==!1&&(n.disable(O),u[O]=!1)}function at(O,re){return f[O]!==re?(n.bindFramebuffer(O,re),f[O]=re,O===n.DRAW_FRAMEBUFFER&&(f[n.FRAMEBUFFER]=re),O===n.FRAMEBUFFER&&(f[n.DRAW_FRAMEBUFFER]=re),!0):!1}function Ge(O,re){let ne=g,we=!1;if(O){ne=d.get(re),ne===void 0&&(ne=[],d.set(re,ne));let ge=O.textures;if(ne.length!==ge.length||ne[0]!==n.COLOR_ATTACHMENT0){for(let be=0,He=ge.length;be<He;be++)ne[be]=n.COLOR_ATTACHMENT0+be;ne.length=ge.length,we=!0}}else ne[0]!==n.BACK&&(ne[0]=n.BACK,we=!0);we&&n.drawBuffers(ne)}function dt(O){return y!==O?(n.useProgram(O),y=O,!0):!1}let ut={[jr]:n.FUNC_ADD,[Rg]:n.FUNC_SUBTRACT,[Pg]:n.FUNC_REVERSE_SUBTRACT};ut[Ig]=n.MIN,ut[Lg]=n.MAX;let st={[Dg]:n.ZERO,[Ng]:n.ONE,[Ug]:n.SRC_COLOR,[td]:n.SRC_ALPHA,[Vg]:n.SRC_ALPHA_SATURATE,[kg]:n.DST_COLOR,[Fg]:n.DST_ALPHA,[Og]:n.ONE_MINUS_SRC_COLOR,[nd]:n.ONE_MINUS_SRC_ALPHA,[zg]:n.ONE_MINUS_DST_COLOR,[Bg]:n.ONE_MINUS_DST_ALPHA,[Gg]:n.CONSTANT_COLOR,[Hg]:n.ONE_MINUS_CONSTANT_COLOR,[Wg]:n.CONSTANT_ALPHA,[Xg]:n.ONE_MINUS_CONSTANT_ALPHA};function en(O,re,ne,we,ge,be,He,Je,le,Be){if(O===Jr){p===!0&&(We(n.BLEND),p=!1);return}if(p===!1&&(Se(n.BLEND),p=!0),O!==Cg){if(O!==m||Be!==N){if((x!==jr||C!==jr)&&(n.blendEquation(n.FUNC_ADD),x=jr,C=jr),Be)switch(O){case la:n.blendFuncSeparate(n.ONE,n.ONE_MINUS_SRC_ALPHA,n.ONE,n.ONE_MINUS_SRC_ALPHA);break;case jf:n.blendFunc(n.ONE,n.ONE);break;case Qf:n.blendFuncSeparate(n.ZERO,n.ONE_MINUS_SRC_COLOR,n.ZERO,n.ONE);break;case ed:n.blendFuncSeparate(n.DST_COLOR,n.ONE_MINUS_SRC_ALPHA,n.ZERO,n.ONE);break;default:Qe("WebGLState: Invalid blending: ",O);break}else switch(O){case la:n.blendFuncSeparate(n.SRC_ALPHA,n.ONE_MINUS_SRC_ALPHA,n.ONE,n.ONE_MINUS_SRC_ALPHA);break;case jf:n.blendFuncSeparate(n.SRC_ALPHA,n.ONE,n.ONE,n.ONE);break;case Qf:Qe("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case ed:Qe("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:Qe("WebGLState: Invalid blending: ",O);break}R=null,S=null,E=null,v=null,T.set(0,0,0),z=0,m=O,N=Be}return}ge=ge||re,be=be||ne,He=He||we,(re!==x||ge!==C)&&(n.blendEquationSeparate(ut[re],ut[ge]),x=re,C=ge),(ne!==R||we!==S||be!==E||He!==v)&&(n.blendFuncSeparate(st[ne],st[we],st[be],st[He]),R=ne,S=we,E=be,v=He),(Je.equals(T)===!1||le!==z)&&(n.blendColor(Je.r,Je.g,Je.b,le),T.copy(Je),z=le),m=O,N=!1}function Xt(O,re){O.side===Ms?We(n.CULL_FACE):Se(n.CULL_FACE);let ne=O.side===pi;re&&(ne=!ne),dn(ne),O.blending===la&&O.transparent===!1?en(Jr):en(O.blending,O.blendEquation,O.blendSrc,O.blendDst,O.blendEquationAlpha,O.blendSrcAlpha,O.blendDstAlpha,O.blendColor,O.blendAlpha,O.premultipliedAlpha),o.setFunc(O.depthFunc),o.setTest(O.depthTest),o.setMask(O.depthWrite),r.setMask(O.colorWrite);let we=O.stencilWrite;a.setTest(we),we&&(a.setMask(O.stencilWriteMask),a.setFunc(O.stencilFunc,O.stencilRef,O.stencilFuncMask),a.setOp(O.stencilFail,O.stencilZFail,O.stencilZPass)),At(O.polygonOffset,O.polygonOffsetFactor,O.polygonOffsetUnits),O.alphaToCoverage===!0?Se(n.SAMPLE_ALPHA_TO_COVERAGE):We(n.SAMPLE_ALPHA_TO_COVERAGE)}function dn(O){D!==O&&(O?n.frontFace(n.CW):n.frontFace(n.CCW),D=O)}function kt(O){O!==Tg?(Se(n.CULL_FACE),O!==W&&(O===Jf?n.cullFace(n.BACK):O===Ag?n.cullFace(n.FRONT):n.cullFace(n.FRONT_AND_BACK))):We(n.CULL_FACE),W=O}function Un(O){O!==G&&(H&&n.lineWidth(O),G=O)}function At(O,re,ne){O?(Se(n.POLYGON_OFFSET_FILL),(U!==re||X!==ne)&&(U=re,X=ne,o.getReversed()&&(re=-re,ne=-ne),n.polygonOffset(re,ne))):We(n.POLYGON_OFFSET_FILL)}function An(O){O?Se(n.SCISSOR_TEST):We(n.SCISSOR_TEST)}function on(O){O===void 0&&(O=n.TEXTURE0+K-1),Q!==O&&(n.activeTexture(O),Q=O)}function pn(O,re,ne){ne===void 0&&(Q===null?ne=n.TEXTURE0+K-1:ne=Q);let we=se[ne];we===void 0&&(we={type:void 0,texture:void 0},se[ne]=we),(we.type!==O||we.texture!==re)&&(Q!==ne&&(n.activeTexture(ne),Q=ne),n.bindTexture(O,re||Ee[O]),we.type=O,we.texture=re)}function F(){let O=se[Q];O!==void 0&&O.type!==void 0&&(n.bindTexture(O.type,null),O.type=void 0,O.texture=void 0)}function Re(){try{n.compressedTexImage2D(...arguments)}catch(O){Qe("WebGLState:",O)}}function $e(){try{n.compressedTexImage3D(...arguments)}catch(O){Qe("WebGLState:",O)}}function lt(){try{n.texSubImage2D(...arguments)}catch(O){Qe("WebGLState:",O)}}function Me(){try{n.texSubImage3D(...arguments)}catch(O){Qe("WebGLState:",O)}}function Gt(){try{n.compressedTexSubImage2D(...arguments)}catch(O){Qe("WebGLState:",O)}}function Ve(){try{n.compressedTexSubImage3D(...arguments)}catch(O){Qe("WebGLState:",O)}}function qe(){try{n.texStorage2D(...arguments)}catch(O){Qe("WebGLState:",O)}}function P(){try{n.texStorage3D(...arguments)}catch(O){Qe("WebGLState:",O)}}function b(){try{n.texImage2D(...arguments)}catch(O){Qe("WebGLState:",O)}}function q(){try{n.texImage3D(...arguments)}catch(O){Qe("WebGLState:",O)}}function ue(O){return h[O]!==void 0?h[O]:n.getParameter(O)}function oe(O,re){h[O]!==re&&(n.pixelStorei(O,re),h[O]=re)}function _e(O){ee.equals(O)===!1&&(n.scissor(O.x,O.y,O.z,O.w),ee.copy(O))}function xe(O){me.equals(O)===!1&&(n.viewport(O.x,O.y,O.z,O.w),me.copy(O))}function te(O,re){let ne=c.get(re);ne===void 0&&(ne=new WeakMap,c.set(re,ne));let we=ne.get(O);we===void 0&&(we=n.getUniformBlockIndex(re,O.name),n.uniformBlockBinding(re,we,we),ne.set(O,we))}function ie(O,re,ne){let ge=c.get(re).get(O);l[ge]!==ne&&(n.bindBufferBase(n.UNIFORM_BUFFER,ge,ne),l[ge]=ne)}function pe(){n.disable(n.BLEND),n.disable(n.CULL_FACE),n.disable(n.DEPTH_TEST),n.disable(n.POLYGON_OFFSET_FILL),n.disable(n.SCISSOR_TEST),n.disable(n.STENCIL_TEST),n.disable(n.SAMPLE_ALPHA_TO_COVERAGE),n.blendEquation(n.FUNC_ADD),n.blendFunc(n.ONE,n.ZERO),n.blendFuncSeparate(n.ONE,n.ZERO,n.ONE,n.ZERO),n.blendColor(0,0,0,0),n.colorMask(!0,!0,!0,!0),n.clearColor(0,0,0,0),n.depthMask(!0),n.depthFunc(n.LESS),o.setReversed(!1),n.clearDepth(1),n.stencilMask(4294967295),n.stencilFunc(n.ALWAYS,0,4294967295),n.stencilOp(n.KEEP,n.KEEP,n.KEEP),n.clearStencil(0),n.cullFace(n.BACK),n.frontFace(n.CCW),n.polygonOffset(0,0),n.activeTexture(n.TEXTURE0),n.bindFramebuffer(n.FRAMEBUFFER,null),n.bindFramebuffer(n.DRAW_FRAMEBUFFER,null),n.bindFramebuffer(n.READ_FRAMEBUFFER,null),n.useProgram(null),n.lineWidth(1),n.scissor(0,0,n.canvas.width,n.canvas.height),n.viewport(0,0,n.canvas.width,n.canvas.height),n.pixelStorei(n.PACK_ALIGNMENT,4),n.pixelStorei(n.UNPACK_ALIGNMENT,4),n.pixelStorei(n.UNPACK_FLIP_Y_WEBGL,!1),n.pixelStorei(n.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),n.pixelStorei(n.UNPACK_COLORSPACE_CONVERSION_WEBGL,n.BROWSER_DEFAULT_WEBGL),n.pixelStorei(n.PACK_ROW_LENGTH,0),n.pixelStorei(n.PACK_SKIP_PIXELS,0),n.pixelStorei(n.PACK_SKIP_ROWS,0),n.pixelStorei(n.UNPACK_ROW_LENGTH,0),n.pixelStorei(n.UNPACK_IMAGE_HEIGHT,0),n.pixelStorei(n.UNPACK_SKIP_PIXELS,0),n.pixelStorei(n.UNPACK_SKIP_ROWS,0),n.pixelStorei(n.UNPACK_SKIP_IMAGES,0),u={},h={},Q=null,se={},f={},l={},d=new WeakMap,g=[],y=null,p=!1,m=null,x=null,R=null,S=null,C=null,E=null,v=null,T=new yt(0,0,0),z=0,N=!1,D=null,W=null,G=null,U=null,X=null,ee.set(0,0,n.canvas.width,n.canvas.height),me.set(0,0,n.canvas.width,n.canvas.height),r.reset(),o.reset(),a.reset()}return{buffers:{color:r,depth:o,stencil:a},enable:Se,disable:We,bindFramebuffer:at,drawBuffers:Ge,useProgram:dt,setBlending:en,setMaterial:Xt,setFlipSided:dn,setCullFace:kt,setLineWidth:Un,setPolygonOffset:At,setScissorTest:An,activeTexture:on,bindTexture:pn,unbindTexture:F,compressedTexImage2D:Re,compressedTexImage3D:$e,texImage2D:b,texImage3D:q,pixelStorei:oe,getParameter:ue,updateUBOMapping:te,uniformBlockBinding:ie,texStorage2D:qe,texStorage3D:P,texSubImage2D:lt,texSubImage3D:Me,compressedTexSubImage2D:Gt,compressedTexSubImage3D:Ve,scissor:_e,viewport:xe,reset:pe}}function L1(n,e,t,i,s,r,o){let a=e.has("WEBGL_multisampled_render_to_texture")?e.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new tt,u=new WeakMap,h=new Set,f,d=new WeakMap,g=new Set,y=new FinalizationRegistry(P=>g.delete(P)),p=!1;try{p=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function m(P,b){return p?new OffscreenCanvas(P,b):nl("canvas")}function x(P,b,q){let ue=1,oe=qe(P);if((oe.width>q||oe.height>q)&&(ue=q/Math.max(oe.width,oe.height)),ue<1)if(typeof HTMLImageElement<"u"&&P instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&P instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&P instanceof ImageBitmap||typeof VideoFrame<"u"&&P instanceof VideoFrame){let _e=Math.floor(ue*oe.width),xe=Math.floor(ue*oe.height);f===void 0&&(f=m(_e,xe));let te=b?m(_e,xe):f;return te.width=_e,te.height=xe,te.getContext("2d").drawImage(P,0,0,_e,xe),Ye("WebGLRenderer: Texture has been resized from ("+oe.width+"x"+oe.height+") to ("+_e+"x"+xe+")."),te}else return"data"in P&&Ye("WebGLRenderer: Image in DataTexture is too big ("+oe.width+"x"+oe.height+")."),P;return P}function R(P){return P.generateMipmaps}function S(P){n.generateMipmap(P)}function C(P){return P.isWebGLCubeRenderTarget?n.TEXTURE_CUBE_MAP:P.isWebGL3DRenderTarget?n.TEXTURE_3D:P.isWebGLArrayRenderTarget||P.isCompressedArrayTexture?n.TEXTURE_2D_ARRAY:n.TEXTURE_2D}function E(P,b,q,ue,oe,_e=!1){if(P!==null){if(n[P]!==void 0)return n[P];Ye("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+P+"'")}let xe;ue&&(xe=e.get("EXT_texture_norm16"),xe||Ye("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let te=b;if(b===n.RED&&(q===n.FLOAT&&(te=n.R32F),q===n.HALF_FLOAT&&(te=n.R16F),q===n.UNSIGNED_BYTE&&(te=n.R8),q===n.UNSIGNED_SHORT&&xe&&(te=xe.R16_EXT),q===n.SHORT&&xe&&(te=xe.R16_SNORM_EXT)),b===n.RED_INTEGER&&(q===n.UNSIGNED_BYTE&&(te=n.R8UI),q===n.UNSIGNED_SHORT&&(te=n.R16UI),q===n.UNSIGNED_INT&&(te=n.R32UI),q===n.BYTE&&(te=n.R8I),q===n.SHORT&&(te=n.R16I),q===n.INT&&(te=n.R32I)),b===n.RG&&(q===n.FLOAT&&(te=n.RG32F),q===n.HALF_FLOAT&&(te=n.RG16F),q===n.UNSIGNED_BYTE&&(te=n.RG8),q===n.UNSIGNED_SHORT&&xe&&(te=xe.RG16_EXT),q===n.SHORT&&xe&&(te=xe.RG16_SNORM_EXT)),b===n.RG_INTEGER&&(q===n.UNSIGNED_BYTE&&(te=n.RG8UI),q===n.UNSIGNED_SHORT&&(te=n.RG16UI),q===n.UNSIGNED_INT&&(te=n.RG32UI),q===n.BYTE&&(te=n.RG8I),q===n.SHORT&&(te=n.RG16I),q===n.INT&&(te=n.RG32I)),b===n.RGB_INTEGER&&(q===n.UNSIGNED_BYTE&&(te=n.RGB8UI),q===n.UNSIGNED_SHORT&&(te=n.RGB16UI),q===n.UNSIGNED_INT&&(te=n.RGB32UI),q===n.BYTE&&(te=n.RGB8I),q===n.SHORT&&(te=n.RGB16I),q===n.INT&&(te=n.RGB32I)),b===n.RGBA_INTEGER&&(q===n.UNSIGNED_BYTE&&(te=n.RGBA8UI),q===n.UNSIGNED_SHORT&&(te=n.RGBA16UI),q===n.UNSIGNED_INT&&(te=n.RGBA32UI),q===n.BYTE&&(te=n.RGBA8I),q===n.SHORT&&(te=n.RGBA16I),q===n.INT&&(te=n.RGBA32I)),b===n.RGB&&(q===n.UNSIGNED_SHORT&&xe&&(te=xe.RGB16_EXT),q===n.SHORT&&xe&&(te=xe.RGB16_SNORM_EXT),q===n.UNSIGNED_INT_5_9_9_9_REV&&(te=n.RGB9_E5),q===n.UNSIGNED_INT_10F_11F_11F_REV&&(te=n.R11F_G11F_B10F)),b===n.RGBA){let ie=_e?el:_t.getTransfer(oe);q===n.FLOAT&&(te=n.RGBA32F),q===n.HALF_FLOAT&&(te=n.RGBA16F),q===n.UNSIGNED_BYTE&&(te=ie===Nt?n.SRGB8_ALPHA8:n.RGBA8),q===n.UNSIGNED_SHORT&&xe&&(te=xe.RGBA16_EXT),q===n.SHORT&&xe&&(te=xe.RGBA16_SNORM_EXT),q===n.UNSIGNED_SHORT_4_4_4_4&&(te=n.RGBA4),q===n.UNSIGNED_SHORT_5_5_5_1&&(te=n.RGB5_A1)}return(te===n.R16F||te===n.R32F||te===n.RG16F||te===n.RG32F||te===n.RGBA16F||te===n.RGBA32F)&&e.get("EXT_color_buffer_float"),te}function v(P,b){let q;return P?b===null||b===is||b===eo?q=n.DEPTH24_STENCIL8:b===ss?q=n.DEPTH32F_STENCIL8:b===ua&&(q=n.DEPTH24_STENCIL8,Ye("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):b===null||b===is||b===eo?q=n.DEPTH_COMPONENT24:b===ss?q=n.DEPTH_COMPONENT32F:b===ua&&(q=n.DEPTH_COMPONENT16),q}function T(P,b){return R(P)===!0||P.isFramebufferTexture&&P.minFilter!==Vn&&P.minFilter!==fi?Math.log2(Math.max(b.width,b.height))+1:P.mipmaps.length>0?P.mipmaps.length:P.isCompressedTexture&&Array.isArray(P.image)?b.mipmaps.length:1}function z(P){let b=new WeakRef(P);i.get(P).__ref=b,g.add(b),y.register(P,b,b)}function N(P){let b=i.get(P).__ref;b!==void 0&&(g.delete(b),y.unregister(b))}function D(P){G(P.target)}function W(P){U(P.target)}function G(P){P.removeEventListener("dispose",D),N(P),K(P),P.isVideoTexture&&u.delete(P),P.isHTMLTexture&&h.delete(P)}function U(P){P.removeEventListener("dispose",W),N(P),ce(P)}function X(){for(let P of g){let b=P.deref();b!==void 0&&(b.isRenderTarget===!0?U(b):G(b))}g.clear(),h.clear()}function K(P){let b=i.get(P);if(b.__webglInit===void 0)return;let q=P.source,ue=d.get(q);if(ue){let oe=ue[b.__cacheKey];oe.usedTimes--,oe.usedTimes===0&&H(P),Object.keys(ue).length===0&&d.delete(q)}i.remove(P)}function H(P){let b=i.get(P);n.deleteTexture(b.__webglTexture);let q=P.source,ue=d.get(q);delete ue[b.__cacheKey],o.memory.textures--}function ce(P){let b=i.get(P);b.__depthDisposeCallback&&b.__depthDisposeCallback();let q=P.depthTexture;if(q&&q.renderTarget===P&&G(q),P.isWebGLCubeRenderTarget)for(let oe=0;oe<6;oe++){if(Array.isArray(b.__webglFramebuffer[oe]))for(let _e=0;_e<b.__webglFramebuffer[oe].length;_e++)n.deleteFramebuffer(b.__webglFramebuffer[oe][_e]);else n.deleteFramebuffer(b.__webglFramebuffer[oe]);b.__webglDepthbuffer&&n.deleteRenderbuffer(b.__webglDepthbuffer[oe])}else{if(Array.isArray(b.__webglFramebuffer))for(let oe=0;oe<b.__webglFramebuffer.length;oe++)n.deleteFramebuffer(b.__webglFramebuffer[oe]);else n.deleteFramebuffer(b.__webglFramebuffer);if(b.__webglDepthbuffer&&n.deleteRenderbuffer(b.__webglDepthbuffer),b.__webglMultisampledFramebuffer&&n.deleteFramebuffer(b.__webglMultisampledFramebuffer),b.__webglColorRenderbuffer)for(let oe=0;oe<b.__webglColorRenderbuffer.length;oe++)b.__webglColorRenderbuffer[oe]&&n.deleteRenderbuffer(b.__webglColorRenderbuffer[oe]);b.__webglDepthRenderbuffer&&n.deleteRenderbuffer(b.__webglDepthRenderbuffer)}let ue=P.textures;for(let oe=0,_e=ue.length;oe<_e;oe++){let xe=i.get(ue[oe]);xe.__webglTexture&&(n.deleteTexture(xe.__webglTexture),o.memory.textures--),i.remove(ue[oe])}i.remove(P)}let J=0;function Q(){J=0}function se(){return J}function fe(P){J=P}function he(){let P=J;return P>=s.maxTextures&&Ye("WebGLTextures: Trying to use "+(P+1)+" texture units while this GPU supports only "+s.maxTextures),J+=1,P}function ee(P){let b=[];return b.push(P.wrapS),b.push(P.wrapT),b.push(P.wrapR||0),b.push(P.magFilter),b.push(P.minFilter),b.push(P.anisotropy),b.push(P.internalFormat),b.push(P.format),b.push(P.type),b.push(P.generateMipmaps),b.push(P.mipmapsAutoUpdate),b.push(P.premultiplyAlpha),b.push(P.flipY),b.push(P.unpackAlignment),b.push(P.colorSpace),b.join()}function me(P,b){let q=i.get(P);if(P.isVideoTexture&&Gt(P),P.isRenderTargetTexture===!1&&P.isExternalTexture!==!0&&P.version>0&&q.__version!==P.version){let ue=P.image;if(ue===null)Ye("WebGLRenderer: Texture marked for update but no image data found.");else if(ue.complete===!1)Ye("WebGLRenderer: Texture marked for update but image is incomplete");else{Xt(q,P,b);return}}else P.isExternalTexture&&(q.__webglTexture=P.sourceTexture?P.sourceTexture:null);t.bindTexture(n.TEXTURE_2D,q.__webglTexture,n.TEXTURE0+b)}function ve(P,b){let q=i.get(P);if(P.isRenderTargetTexture===!1&&P.version>0&&q.__version!==P.version){Xt(q,P,b);return}else P.isExternalTexture&&(q.__webglTexture=P.sourceTexture?P.sourceTexture:null);t.bindTexture(n.TEXTURE_2D_ARRAY,q.__webglTexture,n.TEXTURE0+b)}function Ee(P,b){let q=i.get(P);if(P.isRenderTargetTexture===!1&&P.version>0&&q.__version!==P.version){Xt(q,P,b);return}t.bindTexture(n.TEXTURE_3D,q.__webglTexture,n.TEXTURE0+b)}function Se(P,b){let q=i.get(P);if(P.version>0&&q.__version!==P.version){dn(q,P,b);return}t.bindTexture(n.TEXTURE_CUBE_MAP,q.__webglTexture,n.TEXTURE0+b)}let We={[Yc]:n.REPEAT,[Ss]:n.CLAMP_TO_EDGE,[$c]:n.MIRRORED_REPEAT},at={[Vn]:n.NEAREST,[$g]:n.NEAREST_MIPMAP_NEAREST,[_l]:n.NEAREST_MIPMAP_LINEAR,[fi]:n.LINEAR,[yu]:n.LINEAR_MIPMAP_NEAREST,[Ks]:n.LINEAR_MIPMAP_LINEAR},Ge={[jg]:n.NEVER,[Sd]:n.ALWAYS,[Qg]:n.LESS,[yd]:n.LEQUAL,[e_]:n.EQUAL,[bd]:n.GEQUAL,[t_]:n.GREATER,[n_]:n.NOTEQUAL};function dt(P,b){if(b.type===ss&&e.has("OES_texture_float_linear")===!1&&(b.magFilter===fi||b.magFilter===yu||b.magFilter===_l||b.magFilter===Ks||b.minFilter===fi||b.minFilter===yu||b.minFilter===_l||b.minFilter===Ks)&&Ye("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),n.texParameteri(P,n.TEXTURE_WRAP_S,We[b.wrapS]),n.texParameteri(P,n.TEXTURE_WRAP_T,We[b.wrapT]),(P===n.TEXTURE_3D||P===n.TEXTURE_2D_ARRAY)&&n.texParameteri(P,n.TEXTURE_WRAP_R,We[b.wrapR]),n.texParameteri(P,n.TEXTURE_MAG_FILTER,at[b.magFilter]),n.texParameteri(P,n.TEXTURE_MIN_FILTER,at[b.minFilter]),b.compareFunction&&(n.texParameteri(P,n.TEXTURE_COMPARE_MODE,n.COMPARE_REF_TO_TEXTURE),n.texParameteri(P,n.TEXTURE_COMPARE_FUNC,Ge[b.compareFunction])),e.has("EXT_texture_filter_anisotropic")===!0){if(b.magFilter===Vn||b.minFilter!==_l&&b.minFilter!==Ks||b.type===ss&&e.has("OES_texture_float_linear")===!1)return;if(b.anisotropy>1||i.get(b).__currentAnisotropy){let q=e.get("EXT_texture_filter_anisotropic");n.texParameterf(P,q.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(b.anisotropy,s.getMaxAnisotropy())),i.get(b).__currentAnisotropy=b.anisotropy}}}function ut(P,b){let q=!1;P.__webglInit===void 0&&(P.__webglInit=!0,b.addEventListener("dispose",D),z(b));let ue=b.source,oe=d.get(ue);oe===void 0&&(oe={},d.set(ue,oe));let _e=ee(b);if(_e!==P.__cacheKey){oe[_e]===void 0&&(oe[_e]={texture:n.createTexture(),usedTimes:0},o.memory.textures++,q=!0),oe[_e].usedTimes++;let xe=oe[P.__cacheKey];xe!==void 0&&(oe[P.__cacheKey].usedTimes--,xe.usedTimes===0&&H(b)),P.__cacheKey=_e,P.__webglTexture=oe[_e].texture}return q}function st(P,b,q){return Math.floor(Math.floor(P/q)/b)}function en(P,b,q,ue){let _e=P.updateRanges;if(_e.length===0)t.texSubImage2D(n.TEXTURE_2D,0,0,0,b.width,b.height,q,ue,b.data);else{_e.sort((O,re)=>O.start-re.start);let xe=0;for(let O=1;O<_e.length;O++){let re=_e[xe],ne=_e[O],we=re.start+re.count,ge=st(ne.start,b.width,4),be=st(re.start,b.width,4);ne.start<=we+1&&ge===be&&st(ne.start+ne.count-1,b.width,4)===ge?re.count=Math.max(re.count,ne.start+ne.count-re.start):(++xe,_e[xe]=ne)}_e.length=xe+1;let te=t.getParameter(n.UNPACK_ROW_LENGTH),ie=t.getParameter(n.UNPACK_SKIP_PIXELS),pe=t.getParameter(n.UNPACK_SKIP_ROWS);t.pixelStorei(n.UNPACK_ROW_LENGTH,b.width);for(let O=0,re=_e.length;O<re;O++){let ne=_e[O],we=Math.floor(ne.start/4),ge=Math.ceil(ne.count/4),be=we%b.width,He=Math.floor(we/b.width),Je=ge,le=1;t.pixelStorei(n.UNPACK_SKIP_PIXELS,be),t.pixelStorei(n.UNPACK_SKIP_ROWS,He),t.texSubImage2D(n.TEXTURE_2D,0,be,He,Je,le,q,ue,b.data)}P.clearUpdateRanges(),t.pixelStorei(n.UNPACK_ROW_LENGTH,te),t.pixelStorei(n.UNPACK_SKIP_PIXELS,ie),t.pixelStorei(n.UNPACK_SKIP_ROWS,pe)}}function Xt(P,b,q){let ue=n.TEXTURE_2D;(b.isDataArrayTexture||b.isCompressedArrayTexture)&&(ue=n.TEXTURE_2D_ARRAY),b.isData3DTexture&&(ue=n.TEXTURE_3D);let oe=ut(P,b),_e=b.source;t.bindTexture(ue,P.__webglTexture,n.TEXTURE0+q);let xe=i.get(_e);if(_e.version!==xe.__version||oe===!0){if(t.activeTexture(n.TEXTURE0+q),(typeof ImageBitmap<"u"&&b.image instanceof ImageBitmap)===!1){let le=_t.getPrimaries(_t.workingColorSpace),Be=b.colorSpace===js?null:_t.getPrimaries(b.colorSpace),je=b.colorSpace===js||le===Be?n.NONE:n.BROWSER_DEFAULT_WEBGL;t.pixelStorei(n.UNPACK_FLIP_Y_WEBGL,b.flipY),t.pixelStorei(n.UNPACK_PREMULTIPLY_ALPHA_WEBGL,b.premultiplyAlpha),t.pixelStorei(n.UNPACK_COLORSPACE_CONVERSION_WEBGL,je)}t.pixelStorei(n.UNPACK_ALIGNMENT,b.unpackAlignment);let ie=x(b.image,!1,s.maxTextureSize);ie=Ve(b,ie);let pe=r.convert(b.format,b.colorSpace),O=r.convert(b.type),re=E(b.internalFormat,pe,O,b.normalized,b.colorSpace,b.isVideoTexture);dt(ue,b);let ne,we=b.mipmaps,ge=b.isVideoTexture!==!0,be=xe.__version===void 0||oe===!0,He=_e.dataReady,Je=T(b,ie);if(b.isDepthTexture)re=v(b.format===Js,b.type),be&&(ge?t.texStorage2D(n.TEXTURE_2D,1,re,ie.width,ie.height):t.texImage2D(n.TEXTURE_2D,0,re,ie.width,ie.height,0,pe,O,null));else if(b.isDataTexture)if(we.length>0){ge&&be&&t.texStorage2D(n.TEXTURE_2D,Je,re,we[0].width,we[0].height);for(let le=0,Be=we.length;le<Be;le++)ne=we[le],ge?He&&t.texSubImage2D(n.TEXTURE_2D,le,0,0,ne.width,ne.height,pe,O,ne.data):t.texImage2D(n.TEXTURE_2D,le,re,ne.width,ne.height,0,pe,O,ne.data);b.generateMipmaps=!1}else ge?(be&&t.texStorage2D(n.TEXTURE_2D,Je,re,ie.width,ie.height),He&&en(b,ie,pe,O)):t.texImage2D(n.TEXTURE_2D,0,re,ie.width,ie.height,0,pe,O,ie.data);else if(b.isCompressedTexture)if(b.isCompressedArrayTexture){ge&&be&&t.texStorage3D(n.TEXTURE_2D_ARRAY,Je,re,we[0].width,we[0].height,ie.depth);for(let le=0,Be=we.length;le<Be;le++)if(ne=we[le],b.format!==os)if(pe!==null)if(ge){if(He)if(b.layerUpdates.size>0){let je=Ld(ne.width,ne.height,b.format,b.type);for(let Ce of b.layerUpdates){let ct=ne.data.subarray(Ce*je/ne.data.BYTES_PER_ELEMENT,(Ce+1)*je/ne.data.BYTES_PER_ELEMENT);t.compressedTexSubImage3D(n.TEXTURE_2D_ARRAY,le,0,0,Ce,ne.width,ne.height,1,pe,ct)}}else t.compressedTexSubImage3D(n.TEXTURE_2D_ARRAY,le,0,0,0,ne.width,ne.height,ie.depth,pe,ne.data)}else t.compressedTexImage3D(n.TEXTURE_2D_ARRAY,le,re,ne.width,ne.height,ie.depth,0,ne.data,0,0);else Ye("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else ge?He&&t.texSubImage3D(n.TEXTURE_2D_ARRAY,le,0,0,0,ne.width,ne.height,ie.depth,pe,O,ne.data):t.texImage3D(n.TEXTURE_2D_ARRAY,le,re,ne.width,ne.height,ie.depth,0,pe,O,ne.data);b.layerUpdates.size>0&&b.clearLayerUpdates()}else{ge&&be&&t.texStorage2D(n.TEXTURE_2D,Je,re,we[0].width,we[0].height);for(let le=0,Be=we.length;le<Be;le++)ne=we[le],b.format!==os?pe!==null?ge?He&&t.compressedTexSubImage2D(n.TEXTURE_2D,le,0,0,ne.width,ne.height,pe,ne.data):t.compressedTexImage2D(n.TEXTURE_2D,le,re,ne.width,ne.height,0,ne.data):Ye("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):ge?He&&t.texSubImage2D(n.TEXTURE_2D,le,0,0,ne.width,ne.height,pe,O,ne.data):t.texImage2D(n.TEXTURE_2D,le,re,ne.width,ne.height,0,pe,O,ne.data)}else if(b.isDataArrayTexture)if(ge){if(be&&t.texStorage3D(n.TEXTURE_2D_ARRAY,Je,re,ie.width,ie.height,ie.depth),He)if(b.layerUpdates.size>0){let le=Ld(ie.width,ie.height,b.format,b.type);for(let Be of b.layerUpdates){let je=ie.data.subarray(Be*le/ie.data.BYTES_PER_ELEMENT,(Be+1)*le/ie.data.BYTES_PER_ELEMENT);t.texSubImage3D(n.TEXTURE_2D_ARRAY,0,0,0,Be,ie.width,ie.height,1,pe,O,je)}b.clearLayerUpdates()}else t.texSubImage3D(n.TEXTURE_2D_ARRAY,0,0,0,0,ie.width,ie.height,ie.depth,pe,O,ie.data)}else t.texImage3D(n.TEXTURE_2D_ARRAY,0,re,ie.width,ie.height,ie.depth,0,pe,O,ie.data);else if(b.isData3DTexture)ge?(be&&t.texStorage3D(n.TEXTURE_3D,Je,re,ie.width,ie.height,ie.depth),He&&t.texSubImage3D(n.TEXTURE_3D,0,0,0,0,ie.width,ie.height,ie.depth,pe,O,ie.data)):t.texImage3D(n.TEXTURE_3D,0,re,ie.width,ie.height,ie.depth,0,pe,O,ie.data);else if(b.isFramebufferTexture){if(be)if(ge)t.texStorage2D(n.TEXTURE_2D,Je,re,ie.width,ie.height);else{let le=ie.width,Be=ie.height;for(let je=0;je<Je;je++)t.texImage2D(n.TEXTURE_2D,je,re,le,Be,0,pe,O,null),le>>=1,Be>>=1}}else if(b.isHTMLTexture){if("texElementImage2D"in n){let le=n.canvas;if(le.hasAttribute("layoutsubtree")||le.setAttribute("layoutsubtree","true"),ie.parentNode!==le){le.appendChild(ie),h.add(b),le.onpaint=Be=>{let je=Be.changedElements;for(let Ce of h)je.includes(Ce.image)&&(Ce.needsUpdate=!0)},le.requestPaint();return}if(n.texElementImage2D.length===3)n.texElementImage2D(n.TEXTURE_2D,n.RGBA8,ie);else{let je=n.RGBA,Ce=n.RGBA,ct=n.UNSIGNED_BYTE;n.texElementImage2D(n.TEXTURE_2D,0,je,Ce,ct,ie)}n.texParameteri(n.TEXTURE_2D,n.TEXTURE_MIN_FILTER,n.LINEAR),n.texParameteri(n.TEXTURE_2D,n.TEXTURE_WRAP_S,n.CLAMP_TO_EDGE),n.texParameteri(n.TEXTURE_2D,n.TEXTURE_WRAP_T,n.CLAMP_TO_EDGE)}}else if(we.length>0){if(ge&&be){let le=qe(we[0]);t.texStorage2D(n.TEXTURE_2D,Je,re,le.width,le.height)}for(let le=0,Be=we.length;le<Be;le++)ne=we[le],ge?He&&t.texSubImage2D(n.TEXTURE_2D,le,0,0,pe,O,ne):t.texImage2D(n.TEXTURE_2D,le,re,pe,O,ne);b.generateMipmaps=!1}else if(ge){if(be){let le=qe(ie);t.texStorage2D(n.TEXTURE_2D,Je,re,le.width,le.height)}He&&t.texSubImage2D(n.TEXTURE_2D,0,0,0,pe,O,ie)}else t.texImage2D(n.TEXTURE_2D,0,re,pe,O,ie);R(b)&&b.mipmapsAutoUpdate===!0&&S(ue),xe.__version=_e.version,b.onUpdate&&b.onUpdate(b)}P.__version=b.version}function dn(P,b,q){if(b.image.length!==6)return;let ue=ut(P,b),oe=b.source;t.bindTexture(n.TEXTURE_CUBE_MAP,P.__webglTexture,n.TEXTURE0+q);let _e=i.get(oe);if(oe.version!==_e.__version||ue===!0){t.activeTexture(n.TEXTURE0+q);let xe=_t.getPrimaries(_t.workingColorSpace),te=b.colorSpace===js?null:_t.getPrimaries(b.colorSpace),ie=b.colorSpace===js||xe===te?n.NONE:n.BROWSER_DEFAULT_WEBGL;t.pixelStorei(n.UNPACK_FLIP_Y_WEBGL,b.flipY),t.pixelStorei(n.UNPACK_PREMULTIPLY_ALPHA_WEBGL,b.premultiplyAlpha),t.pixelStorei(n.UNPACK_ALIGNMENT,b.unpackAlignment),t.pixelStorei(n.UNPACK_COLORSPACE_CONVERSION_WEBGL,ie);let pe=b.isCompressedTexture||b.image[0].isCompressedTexture,O=b.image[0]&&b.image[0].isDataTexture,re=[];for(let Ce=0;Ce<6;Ce++)!pe&&!O?re[Ce]=x(b.image[Ce],!0,s.maxCubemapSize):re[Ce]=O?b.image[Ce].image:b.image[Ce],re[Ce]=Ve(b,re[Ce]);let ne=re[0],we=r.convert(b.format,b.colorSpace),ge=r.convert(b.type),be=E(b.internalFormat,we,ge,b.normalized,b.colorSpace),He=b.isVideoTexture!==!0,Je=_e.__version===void 0||ue===!0,le=oe.dataReady,Be=T(b,ne);dt(n.TEXTURE_CUBE_MAP,b);let je;if(b.isDepthTexture){if(be=v(b.format===Js,b.type),Je)if(He)t.texStorage2D(n.TEXTURE_CUBE_MAP,1,be,ne.width,ne.height);else for(let Ce=0;Ce<6;Ce++)t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,be,ne.width,ne.height,0,we,ge,null)}else if(pe){He&&Je&&t.texStorage2D(n.TEXTURE_CUBE_MAP,Be,be,ne.width,ne.height);for(let Ce=0;Ce<6;Ce++){je=re[Ce].mipmaps;for(let ct=0;ct<je.length;ct++){let qt=je[ct];b.format!==os?we!==null?He?le&&t.compressedTexSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ct,0,0,qt.width,qt.height,we,qt.data):t.compressedTexImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ct,be,qt.width,qt.height,0,qt.data):Ye("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):He?le&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ct,0,0,qt.width,qt.height,we,ge,qt.data):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ct,be,qt.width,qt.height,0,we,ge,qt.data)}}}else{if(je=b.mipmaps,He&&Je){je.length>0&&Be++;let Ce=qe(re[0]);t.texStorage2D(n.TEXTURE_CUBE_MAP,Be,be,Ce.width,Ce.height)}for(let Ce=0;Ce<6;Ce++)if(O){He?le&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,0,0,re[Ce].width,re[Ce].height,we,ge,re[Ce].data):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,be,re[Ce].width,re[Ce].height,0,we,ge,re[Ce].data);for(let ct=0;ct<je.length;ct++){let si=je[ct].image[Ce].image;He?le&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ct+1,0,0,si.width,si.height,we,ge,si.data):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ct+1,be,si.width,si.height,0,we,ge,si.data)}}else{He?le&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,0,0,we,ge,re[Ce]):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,0,be,we,ge,re[Ce]);for(let ct=0;ct<je.length;ct++){let qt=je[ct];He?le&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ct+1,0,0,we,ge,qt.image[Ce]):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+Ce,ct+1,be,we,ge,qt.image[Ce])}}}R(b)&&b.mipmapsAutoUpdate===!0&&S(n.TEXTURE_CUBE_MAP),_e.__version=oe.version,b.onUpdate&&b.onUpdate(b)}P.__version=b.version}function kt(P,b,q,ue,oe,_e){let xe=r.convert(q.format,q.colorSpace),te=r.convert(q.type),ie=E(q.internalFormat,xe,te,q.normalized,q.colorSpace),pe=i.get(b),O=i.get(q);if(O.__renderTarget=b,!pe.__hasExternalTextures){let re=Math.max(1,b.width>>_e),ne=Math.max(1,b.height>>_e);oe===n.TEXTURE_3D||oe===n.TEXTURE_2D_ARRAY?t.texImage3D(oe,_e,ie,re,ne,b.depth,0,xe,te,null):t.texImage2D(oe,_e,ie,re,ne,0,xe,te,null)}t.bindFramebuffer(n.FRAMEBUFFER,P),Me(b)?a.framebufferTexture2DMultisampleEXT(n.FRAMEBUFFER,ue,oe,O.__webglTexture,0,lt(b)):(oe===n.TEXTURE_2D||oe>=n.TEXTURE_CUBE_MAP_POSITIVE_X&&oe<=n.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&n.framebufferTexture2D(n.FRAMEBUFFER,ue,oe,O.__webglTexture,_e),t.bindFramebuffer(n.FRAMEBUFFER,null)}function Un(P,b,q){if(n.bindRenderbuffer(n.RENDERBUFFER,P),b.depthBuffer){let ue=b.depthTexture,oe=ue&&ue.isDepthTexture?ue.type:null,_e=v(b.stencilBuffer,oe),xe=b.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT;Me(b)?a.renderbufferStorageMultisampleEXT(n.RENDERBUFFER,lt(b),_e,b.width,b.height):q?n.renderbufferStorageMultisample(n.RENDERBUFFER,lt(b),_e,b.width,b.height):n.renderbufferStorage(n.RENDERBUFFER,_e,b.width,b.height),n.framebufferRenderbuffer(n.FRAMEBUFFER,xe,n.RENDERBUFFER,P)}else{let ue=b.textures;for(let oe=0;oe<ue.length;oe++){let _e=ue[oe],xe=r.convert(_e.format,_e.colorSpace),te=r.convert(_e.type),ie=E(_e.internalFormat,xe,te,_e.normalized,_e.colorSpace);Me(b)?a.renderbufferStorageMultisampleEXT(n.RENDERBUFFER,lt(b),ie,b.width,b.height):q?n.renderbufferStorageMultisample(n.RENDERBUFFER,lt(b),ie,b.width,b.height):n.renderbufferStorage(n.RENDERBUFFER,ie,b.width,b.height)}}n.bindRenderbuffer(n.RENDERBUFFER,null)}function At(P,b,q){let ue=b.isWebGLCubeRenderTarget===!0;if(t.bindFramebuffer(n.FRAMEBUFFER,P),!(b.depthTexture&&b.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let oe=i.get(b.depthTexture);oe.__renderTarget=b;let _e=ue?b.depthTexture.image[0]:b.depthTexture.image;(!oe.__webglTexture||_e.width!==b.width||_e.height!==b.height)&&(_e.width=b.width,_e.height=b.height,b.depthTexture.needsUpdate=!0),ue?Se(b.depthTexture,0):me(b.depthTexture,0);let xe=oe.__webglTexture,te=lt(b),ie=ue?n.TEXTURE_CUBE_MAP_POSITIVE_X+q:n.TEXTURE_2D,pe=b.depthTexture.format===Js?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT;if(b.depthTexture.format===Xs)Me(b)?a.framebufferTexture2DMultisampleEXT(n.FRAMEBUFFER,pe,ie,xe,0,te):n.framebufferTexture2D(n.FRAMEBUFFER,pe,ie,xe,0);else if(b.depthTexture.format===Js)Me(b)?a.framebufferTexture2DMultisampleEXT(n.FRAMEBUFFER,pe,ie,xe,0,te):n.framebufferTexture2D(n.FRAMEBUFFER,pe,ie,xe,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function An(P){let b=i.get(P),q=P.isWebGLCubeRenderTarget===!0;if(b.__boundDepthTexture!==P.depthTexture){let ue=P.depthTexture;if(b.__depthDisposeCallback&&b.__depthDisposeCallback(),ue){let oe=()=>{delete b.__boundDepthTexture,delete b.__depthDisposeCallback,ue.removeEventListener("dispose",oe)};ue.addEventListener("dispose",oe),b.__depthDisposeCallback=oe}b.__boundDepthTexture=ue}if(P.depthTexture&&!b.__autoAllocateDepthBuffer)if(q)for(let ue=0;ue<6;ue++)At(b.__webglFramebuffer[ue],P,ue);else P.texture.mipmaps.length>0?At(b.__webglFramebuffer[0],P,0):At(b.__webglFramebuffer,P,0);else if(q){b.__webglDepthbuffer=[];for(let ue=0;ue<6;ue++)if(t.bindFramebuffer(n.FRAMEBUFFER,b.__webglFramebuffer[ue]),b.__webglDepthbuffer[ue]===void 0)b.__webglDepthbuffer[ue]=n.createRenderbuffer(),Un(b.__webglDepthbuffer[ue],P,!1);else{let oe=P.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT,_e=b.__webglDepthbuffer[ue];n.bindRenderbuffer(n.RENDERBUFFER,_e),n.framebufferRenderbuffer(n.FRAMEBUFFER,oe,n.RENDERBUFFER,_e)}}else if(P.texture.mipmaps.length>0?t.bindFramebuffer(n.FRAMEBUFFER,b.__webglFramebuffer[0]):t.bindFramebuffer(n.FRAMEBUFFER,b.__webglFramebuffer),b.__webglDepthbuffer===void 0)b.__webglDepthbuffer=n.createRenderbuffer(),Un(b.__webglDepthbuffer,P,!1);else{let oe=P.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT,_e=b.__webglDepthbuffer;n.bindRenderbuffer(n.RENDERBUFFER,_e),n.framebufferRenderbuffer(n.FRAMEBUFFER,oe,n.RENDERBUFFER,_e)}t.bindFramebuffer(n.FRAMEBUFFER,null)}function on(P,b,q){let ue=i.get(P);b!==void 0&&kt(ue.__webglFramebuffer,P,P.texture,n.COLOR_ATTACHMENT0,n.TEXTURE_2D,0),q!==void 0&&An(P)}function pn(P){let b=P.texture,q=i.get(P),ue=i.get(b);P.addEventListener("dispose",W),z(P);let oe=P.textures,_e=P.isWebGLCubeRenderTarget===!0,xe=oe.length>1;if(xe||(ue.__webglTexture===void 0&&(ue.__webglTexture=n.createTexture()),ue.__version=b.version,o.memory.textures++),_e){q.__webglFramebuffer=[];for(let te=0;te<6;te++)if(b.mipmaps.length>0){q.__webglFramebuffer[te]=[];for(let ie=0;ie<b.mipmaps.length;ie++)q.__webglFramebuffer[te][ie]=n.createFramebuffer()}else q.__webglFramebuffer[te]=n.createFramebuffer()}else{if(b.mipmaps.length>0){q.__webglFramebuffer=[];for(let te=0;te<b.mipmaps.length;te++)q.__webglFramebuffer[te]=n.createFramebuffer()}else q.__webglFramebuffer=n.createFramebuffer();if(xe)for(let te=0,ie=oe.length;te<ie;te++){let pe=i.get(oe[te]);pe.__webglTexture===void 0&&(pe.__webglTexture=n.createTexture(),o.memory.textures++)}if(P.samples>0&&Me(P)===!1){q.__webglMultisampledFramebuffer=n.createFramebuffer(),q.__webglColorRenderbuffer=[],t.bindFramebuffer(n.FRAMEBUFFER,q.__webglMultisampledFramebuffer);for(let te=0;te<oe.length;te++){let ie=oe[te];q.__webglColorRenderbuffer[te]=n.createRenderbuffer(),n.bindRenderbuffer(n.RENDERBUFFER,q.__webglColorRenderbuffer[te]);let pe=r.convert(ie.format,ie.colorSpace),O=r.convert(ie.type),re=E(ie.internalFormat,pe,O,ie.normalized,ie.colorSpace,P.isXRRenderTarget===!0),ne=lt(P);n.renderbufferStorageMultisample(n.RENDERBUFFER,ne,re,P.width,P.height),n.framebufferRenderbuffer(n.FRAMEBUFFER,n.COLOR_ATTACHMENT0+te,n.RENDERBUFFER,q.__webglColorRenderbuffer[te])}n.bindRenderbuffer(n.RENDERBUFFER,null),P.depthBuffer&&(q.__webglDepthRenderbuffer=n.createRenderbuffer(),Un(q.__webglDepthRenderbuffer,P,!0)),t.bindFramebuffer(n.FRAMEBUFFER,null)}}if(_e){t.bindTexture(n.TEXTURE_CUBE_MAP,ue.__webglTexture),dt(n.TEXTURE_CUBE_MAP,b);for(let te=0;te<6;te++)if(b.mipmaps.length>0)for(let ie=0;ie<b.mipmaps.length;ie++)kt(q.__webglFramebuffer[te][ie],P,b,n.COLOR_ATTACHMENT0,n.TEXTURE_CUBE_MAP_POSITIVE_X+te,ie);else kt(q.__webglFramebuffer[te],P,b,n.COLOR_ATTACHMENT0,n.TEXTURE_CUBE_MAP_POSITIVE_X+te,0);R(b)?S(n.TEXTURE_CUBE_MAP):b.mipmaps.length>0&&n.texParameteri(n.TEXTURE_CUBE_MAP,n.TEXTURE_MAX_LEVEL,b.mipmaps.length-1),t.unbindTexture()}else if(xe){for(let te=0,ie=oe.length;te<ie;te++){let pe=oe[te],O=i.get(pe),re=n.TEXTURE_2D;(P.isWebGL3DRenderTarget||P.isWebGLArrayRenderTarget)&&(re=P.isWebGL3DRenderTarget?n.TEXTURE_3D:n.TEXTURE_2D_ARRAY),t.bindTexture(re,O.__webglTexture),dt(re,pe),kt(q.__webglFramebuffer,P,pe,n.COLOR_ATTACHMENT0+te,re,0),R(pe)&&S(re)}t.unbindTexture()}else{let te=n.TEXTURE_2D;if((P.isWebGL3DRenderTarget||P.isWebGLArrayRenderTarget)&&(te=P.isWebGL3DRenderTarget?n.TEXTURE_3D:n.TEXTURE_2D_ARRAY),t.bindTexture(te,ue.__webglTexture),dt(te,b),b.mipmaps.length>0)for(let ie=0;ie<b.mipmaps.length;ie++)kt(q.__webglFramebuffer[ie],P,b,n.COLOR_ATTACHMENT0,te,ie);else kt(q.__webglFramebuffer,P,b,n.COLOR_ATTACHMENT0,te,0);R(b)?S(te):b.mipmaps.length>0&&n.texParameteri(te,n.TEXTURE_MAX_LEVEL,b.mipmaps.length-1),t.unbindTexture()}P.depthBuffer&&An(P)}function F(P){let b=P.textures;for(let q=0,ue=b.length;q<ue;q++){let oe=b[q];if(R(oe)&&oe.mipmapsAutoUpdate===!0){let _e=C(P),xe=i.get(oe).__webglTexture;t.bindTexture(_e,xe),S(_e),t.unbindTexture()}}}let Re=[];function $e(P){if(P.samples>0){if(Me(P)===!1){let b=P.textures,q=P.width,ue=P.height,oe=n.COLOR_BUFFER_BIT,_e=P.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT,xe=i.get(P),te=b.length>1;if(te)for(let pe=0;pe<b.length;pe++)t.bindFramebuffer(n.FRAMEBUFFER,xe.__webglMultisampledFramebuffer),n.framebufferRenderbuffer(n.FRAMEBUFFER,n.COLOR_ATTACHMENT0+pe,n.RENDERBUFFER,null),t.bindFramebuffer(n.FRAMEBUFFER,xe.__webglFramebuffer),n.framebufferTexture2D(n.DRAW_FRAMEBUFFER,n.COLOR_ATTACHMENT0+pe,n.TEXTURE_2D,null,0);t.bindFramebuffer(n.READ_FRAMEBUFFER,xe.__webglMultisampledFramebuffer),P.texture.mipmaps.length>0?t.bindFramebuffer(n.DRAW_FRAMEBUFFER,xe.__webglFramebuffer[0]):t.bindFramebuffer(n.DRAW_FRAMEBUFFER,xe.__webglFramebuffer);for(let pe=0;pe<b.length;pe++){if(P.resolveDepthBuffer&&(P.depthBuffer&&(oe|=n.DEPTH_BUFFER_BIT),P.stencilBuffer&&P.resolveStencilBuffer&&(oe|=n.STENCIL_BUFFER_BIT)),te){n.framebufferRenderbuffer(n.READ_FRAMEBUFFER,n.COLOR_ATTACHMENT0,n.RENDERBUFFER,xe.__webglColorRenderbuffer[pe]);let O=i.get(b[pe]).__webglTexture;n.framebufferTexture2D(n.DRAW_FRAMEBUFFER,n.COLOR_ATTACHMENT0,n.TEXTURE_2D,O,0)}n.blitFramebuffer(0,0,q,ue,0,0,q,ue,oe,n.NEAREST),l===!0&&(Re.length=0,Re.push(n.COLOR_ATTACHMENT0+pe),P.depthBuffer&&P.storeMultisampledDepthBuffer===!1&&Re.push(_e),n.invalidateFramebuffer(n.READ_FRAMEBUFFER,Re))}if(t.bindFramebuffer(n.READ_FRAMEBUFFER,null),t.bindFramebuffer(n.DRAW_FRAMEBUFFER,null),te)for(let pe=0;pe<b.length;pe++){t.bindFramebuffer(n.FRAMEBUFFER,xe.__webglMultisampledFramebuffer),n.framebufferRenderbuffer(n.FRAMEBUFFER,n.COLOR_ATTACHMENT0+pe,n.RENDERBUFFER,xe.__webglColorRenderbuffer[pe]);let O=i.get(b[pe]).__webglTexture;t.bindFramebuffer(n.FRAMEBUFFER,xe.__webglFramebuffer),n.framebufferTexture2D(n.DRAW_FRAMEBUFFER,n.COLOR_ATTACHMENT0+pe,n.TEXTURE_2D,O,0)}t.bindFramebuffer(n.DRAW_FRAMEBUFFER,xe.__webglMultisampledFramebuffer)}else if(P.depthBuffer&&P.storeMultisampledDepthBuffer===!1&&l){let b=P.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT;n.invalidateFramebuffer(n.DRAW_FRAMEBUFFER,[b])}}}function lt(P){return Math.min(s.maxSamples,P.samples)}function Me(P){let b=i.get(P);return P.samples>0&&e.has("WEBGL_multisampled_render_to_texture")===!0&&b.__useRenderToTexture!==!1}function Gt(P){let b=o.render.frame;u.get(P)!==b&&(u.set(P,b),P.update())}function Ve(P,b){let q=P.colorSpace,ue=P.format,oe=P.type;return P.isCompressedTexture===!0||P.isVideoTexture===!0||q!==Zr&&q!==js&&(_t.getTransfer(q)===Nt?(ue!==os||oe!==Ii)&&Ye("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):Qe("WebGLTextures: Unsupported texture color space:",q)),b}function qe(P){return typeof HTMLImageElement<"u"&&P instanceof HTMLImageElement?(c.width=P.naturalWidth||P.width,c.height=P.naturalHeight||P.height):typeof VideoFrame<"u"&&P instanceof VideoFrame?(c.width=P.displayWidth,c.height=P.displayHeight):(c.width=P.width,c.height=P.height),c}this.allocateTextureUnit=he,this.resetTextureUnits=Q,this.getTextureUnits=se,this.setTextureUnits=fe,this.setTexture2D=me,this.setTexture2DArray=ve,this.setTexture3D=Ee,this.setTextureCube=Se,this.rebindTextures=on,this.setupRenderTarget=pn,this.updateRenderTargetMipmap=F,this.updateMultisampleRenderTarget=$e,this.setupDepthRenderbuffer=An,this.setupFrameBufferTexture=kt,this.useMultisampledRTT=Me,this.dispose=X}function D1(n,e){function t(i,s=js){let r,o=_t.getTransfer(s);if(i===Ii)return n.UNSIGNED_BYTE;if(i===Su)return n.UNSIGNED_SHORT_4_4_4_4;if(i===Mu)return n.UNSIGNED_SHORT_5_5_5_1;if(i===pd)return n.UNSIGNED_INT_5_9_9_9_REV;if(i===md)return n.UNSIGNED_INT_10F_11F_11F_REV;if(i===fd)return n.BYTE;if(i===dd)return n.SHORT;if(i===ua)return n.UNSIGNED_SHORT;if(i===bu)return n.INT;if(i===is)return n.UNSIGNED_INT;if(i===ss)return n.FLOAT;if(i===rs)return n.HALF_FLOAT;if(i===gd)return n.ALPHA;if(i===_d)return n.RGB;if(i===os)return n.RGBA;if(i===Xs)return n.DEPTH_COMPONENT;if(i===Js)return n.DEPTH_STENCIL;if(i===vd)return n.RED;if(i===wu)return n.RED_INTEGER;if(i===Rr)return n.RG;if(i===Tu)return n.RG_INTEGER;if(i===Au)return n.RGBA_INTEGER;if(i===vl||i===xl||i===yl||i===bl)if(o===Nt)if(r=e.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(i===vl)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(i===xl)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(i===yl)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(i===bl)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=e.get("WEBGL_compressed_texture_s3tc"),r!==null){if(i===vl)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(i===xl)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(i===yl)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(i===bl)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(i===Eu||i===Cu||i===Ru||i===Pu)if(r=e.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(i===Eu)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(i===Cu)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(i===Ru)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(i===Pu)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(i===Iu||i===Lu||i===Du||i===Nu||i===Uu||i===Sl||i===Ou)if(r=e.get("WEBGL_compressed_texture_etc"),r!==null){if(i===Iu||i===Lu)return o===Nt?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(i===Du)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(i===Nu)return r.COMPRESSED_R11_EAC;if(i===Uu)return r.COMPRESSED_SIGNED_R11_EAC;if(i===Sl)return r.COMPRESSED_RG11_EAC;if(i===Ou)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(i===Fu||i===Bu||i===ku||i===zu||i===Vu||i===Gu||i===Hu||i===Wu||i===Xu||i===qu||i===Yu||i===$u||i===Zu||i===Ku)if(r=e.get("WEBGL_compressed_texture_astc"),r!==null){if(i===Fu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(i===Bu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(i===ku)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(i===zu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(i===Vu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(i===Gu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(i===Hu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(i===Wu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(i===Xu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(i===qu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(i===Yu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(i===$u)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(i===Zu)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(i===Ku)return o===Nt?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(i===Ju||i===ju||i===Qu)if(r=e.get("EXT_texture_compression_bptc"),r!==null){if(i===Ju)return o===Nt?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(i===ju)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(i===Qu)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(i===eh||i===th||i===Ml||i===nh)if(r=e.get("EXT_texture_compression_rgtc"),r!==null){if(i===eh)return r.COMPRESSED_RED_RGTC1_EXT;if(i===th)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(i===Ml)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(i===nh)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return i===eo?n.UNSIGNED_INT_24_8:n[i]!==void 0?n[i]:null}return{convert:t}}var N1=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,U1=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,Vd=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let i=new cl(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=i}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,i=new Vi({vertexShader:N1,fragmentShader:U1,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new zi(new ul(20,20),i)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},Gd=class extends es{constructor(e,t){super();let i=this,s=null,r=1,o=null,a="local-floor",l=1,c=null,u=null,h=null,f=null,d=null,g=null,y=typeof XRWebGLBinding<"u",p=new Vd,m={},x=t.getContextAttributes(),R=null,S=null,C=[],E=[],v=new tt,T=null,z=null,N=new hi;N.viewport=new rn;let D=new hi;D.viewport=new rn;let W=[N,D],G=new _u,U=null,X=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(ee){let me=C[ee];return me===void 0&&(me=new ea,C[ee]=me),me.getTargetRaySpace()},this.getControllerGrip=function(ee){let me=C[ee];return me===void 0&&(me=new ea,C[ee]=me),me.getGripSpace()},this.getHand=function(ee){let me=C[ee];return me===void 0&&(me=new ea,C[ee]=me),me.getHandSpace()};function K(ee){let me=E.indexOf(ee.inputSource);if(me===-1)return;let ve=C[me];ve!==void 0&&(ve.update(ee.inputSource,ee.frame,c||o),ve.dispatchEvent({type:ee.type,data:ee.inputSource}))}function H(){s.removeEventListener("select",K),s.removeEventListener("selectstart",K),s.removeEventListener("selectend",K),s.removeEventListener("squeeze",K),s.removeEventListener("squeezestart",K),s.removeEventListener("squeezeend",K),s.removeEventListener("end",H),s.removeEventListener("inputsourceschange",ce);for(let ee=0;ee<C.length;ee++){let me=E[ee];me!==null&&(E[ee]=null,C[ee].disconnect(me))}U=null,X=null,p.reset();for(let ee in m)delete m[ee];if(e.setRenderTarget(R),d=null,f=null,h=null,s=null,S=null,he.stop(),i.isPresenting=!1,e.setPixelRatio(T),e.setSize(v.width,v.height,!1),z!==null){let ee=z.camera;ee.fov=z.fov,ee.zoom=z.zoom,ee.updateProjectionMatrix(),z=null}i.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(ee){r=ee,i.isPresenting===!0&&Ye("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(ee){a=ee,i.isPresenting===!0&&Ye("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||o},this.setReferenceSpace=function(ee){c=ee},this.getBaseLayer=function(){return f!==null?f:d},this.getBinding=function(){return h===null&&y&&(h=new XRWebGLBinding(s,t)),h},this.getFrame=function(){return g},this.getSession=function(){return s},this.setSession=async function(ee){if(s=ee,s!==null){if(R=e.getRenderTarget(),s.addEventListener("select",K),s.addEventListener("selectstart",K),s.addEventListener("selectend",K),s.addEventListener("squeeze",K),s.addEventListener("squeezestart",K),s.addEventListener("squeezeend",K),s.addEventListener("end",H),s.addEventListener("inputsourceschange",ce),x.xrCompatible!==!0&&await t.makeXRCompatible(),T=e.getPixelRatio(),e.getSize(v),y&&"createProjectionLayer"in XRWebGLBinding.prototype){let ve=null,Ee=null,Se=null;x.depth&&(Se=x.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,ve=x.stencil?Js:Xs,Ee=x.stencil?eo:is);let We={colorFormat:t.RGBA8,depthFormat:Se,scaleFactor:r};h=this.getBinding(),f=h.createProjectionLayer(We),s.updateRenderState({layers:[f]}),e.setPixelRatio(1),e.setSize(f.textureWidth,f.textureHeight,!1),S=new Ri(f.textureWidth,f.textureHeight,{format:os,type:Ii,depthTexture:new Zs(f.textureWidth,f.textureHeight,Ee,void 0,void 0,void 0,void 0,void 0,void 0,ve),stencilBuffer:x.stencil,colorSpace:e.outputColorSpace,samples:x.antialias?4:0,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}else{let ve={antialias:x.antialias,alpha:!0,depth:x.depth,stencil:x.stencil,framebufferScaleFactor:r};d=new XRWebGLLayer(s,t,ve),s.updateRenderState({baseLayer:d}),e.setPixelRatio(1),e.setSize(d.framebufferWidth,d.framebufferHeight,!1),S=new Ri(d.framebufferWidth,d.framebufferHeight,{format:os,type:Ii,colorSpace:e.outputColorSpace,stencilBuffer:x.stencil,resolveDepthBuffer:d.ignoreDepthValues===!1,resolveStencilBuffer:d.ignoreDepthValues===!1,storeMultisampledDepthBuffer:d.ignoreDepthValues===!1,storeMultisampledStencilBuffer:d.ignoreDepthValues===!1})}S.isXRRenderTarget=!0,this.setFoveation(l),c=null,o=await s.requestReferenceSpace(a),he.setContext(s),he.start(),i.isPresenting=!0,i.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return p.getDepthTexture()};function ce(ee){for(let me=0;me<ee.removed.length;me++){let ve=ee.removed[me],Ee=E.indexOf(ve);Ee>=0&&(E[Ee]=null,C[Ee].disconnect(ve))}for(let me=0;me<ee.added.length;me++){let ve=ee.added[me],Ee=E.indexOf(ve);if(Ee===-1){for(let We=0;We<C.length;We++)if(We>=E.length){E.push(ve),Ee=We;break}else if(E[We]===null){E[We]=ve,Ee=We;break}if(Ee===-1)break}let Se=C[Ee];Se&&Se.connect(ve)}}function J(ee,me){me===null?ee.matrixWorld.copy(ee.matrix):ee.matrixWorld.multiplyMatrices(me.matrixWorld,ee.matrix),ee.matrixWorldInverse.copy(ee.matrixWorld).invert()}this.updateCamera=function(ee){if(s===null)return;let me=ee.near,ve=ee.far;p.texture!==null&&(p.depthNear>0&&(me=p.depthNear),p.depthFar>0&&(ve=p.depthFar)),G.near=D.near=N.near=me,G.far=D.far=N.far=ve,(U!==G.near||X!==G.far)&&(s.updateRenderState({depthNear:G.near,depthFar:G.far}),U=G.near,X=G.far),G.layers.mask=ee.layers.mask|6,N.layers.mask=G.layers.mask&-5,D.layers.mask=G.layers.mask&-3;let Ee=ee.parent,Se=G.cameras;J(G,Ee);for(let We=0;We<Se.length;We++)J(Se[We],Ee);G.projectionMatrix.copy(N.projectionMatrix),G.projectionMatrixInverse.copy(N.projectionMatrixInverse),z===null&&ee.isPerspectiveCamera&&(z={camera:ee,fov:ee.fov,zoom:ee.zoom}),Q(ee,G,Ee)};function Q(ee,me,ve){ve===null?ee.matrix.copy(me.matrixWorld):(ee.matrix.copy(ve.matrixWorld),ee.matrix.invert(),ee.matrix.multiply(me.matrixWorld)),ee.matrix.decompose(ee.position,ee.quaternion,ee.scale),ee.updateMatrixWorld(!0),ee.projectionMatrix.copy(me.projectionMatrix),ee.projectionMatrixInverse.copy(me.projectionMatrixInverse),ee.isPerspectiveCamera&&(ee.fov=Jo*2*Math.atan(1/ee.projectionMatrix.elements[5]),ee.zoom=1)}this.getCamera=function(){return G},this.getFoveation=function(){if(!(f===null&&d===null))return l},this.setFoveation=function(ee){l=ee,f!==null&&(f.fixedFoveation=ee),d!==null&&d.fixedFoveation!==void 0&&(d.fixedFoveation=ee)},this.hasDepthSensing=function(){return p.texture!==null},this.getDepthSensingMesh=function(){return p.getMesh(G)},this.getCameraTexture=function(ee){return m[ee]};let se=null;function fe(ee,me){if(u=me.getViewerPose(c||o),g=me,u!==null){let ve=u.views;d!==null&&(e.setRenderTargetFramebuffer(S,d.framebuffer),e.setRenderTarget(S));let Ee=!1;ve.length!==G.cameras.length&&(G.cameras.length=0,Ee=!0);for(let Ge=0;Ge<ve.length;Ge++){let dt=ve[Ge],ut=null;if(d!==null)ut=d.getViewport(dt);else{let en=h.getViewSubImage(f,dt);ut=en.viewport,Ge===0&&(e.setRenderTargetTextures(S,en.colorTexture,en.depthStencilTexture),e.setRenderTarget(S))}let st=W[Ge];st===void 0&&(st=new hi,st.layers.enable(Ge),st.viewport=new rn,W[Ge]=st),st.matrix.fromArray(dt.transform.matrix),st.matrix.decompose(st.position,st.quaternion,st.scale),st.projectionMatrix.fromArray(dt.projectionMatrix),st.projectionMatrixInverse.copy(st.projectionMatrix).invert(),st.viewport.set(ut.x,ut.y,ut.width,ut.height),Ge===0&&(G.matrix.copy(st.matrix),G.matrix.decompose(G.position,G.quaternion,G.scale)),Ee===!0&&G.cameras.push(st)}let Se=s.enabledFeatures;if(Se&&Se.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&y){h=i.getBinding();let Ge=h.getDepthInformation(ve[0]);Ge&&Ge.isValid&&Ge.texture&&p.init(Ge,s.renderState)}if(Se&&Se.includes("camera-access")&&y){e.state.unbindTexture(),h=i.getBinding();for(let Ge=0;Ge<ve.length;Ge++){let dt=ve[Ge].camera;if(dt){let ut=m[dt];ut||(ut=new cl,m[dt]=ut);let st=h.getCameraImage(dt);ut.sourceTexture=st}}}}for(let ve=0;ve<C.length;ve++){let Ee=E[ve],Se=C[ve];Ee!==null&&Se!==void 0&&Se.update(Ee,me,c||o)}se&&se(ee,me),me.detectedPlanes&&i.dispatchEvent({type:"planesdetected",data:me}),g=null}let he=new U_;he.setAnimationLoop(fe),this.setAnimationLoop=function(ee){se=ee},this.dispose=function(){}}},O1=new Mt,X_=new nt;X_.set(-1,0,0,0,1,0,0,0,1);function F1(n,e){function t(p,m){p.matrixAutoUpdate===!0&&p.updateMatrix(),m.value.copy(p.matrix)}function i(p,m){m.color.getRGB(p.fogColor.value,Rd(n)),m.isFog?(p.fogNear.value=m.near,p.fogFar.value=m.far):m.isFogExp2&&(p.fogDensity.value=m.density)}function s(p,m,x,R,S){m.isNodeMaterial?m.uniformsNeedUpdate=!1:m.isMeshBasicMaterial?r(p,m):m.isMeshLambertMaterial?(r(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshToonMaterial?(r(p,m),h(p,m)):m.isMeshPhongMaterial?(r(p,m),u(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshStandardMaterial?(r(p,m),f(p,m),m.isMeshPhysicalMaterial&&d(p,m,S)):m.isMeshMatcapMaterial?(r(p,m),g(p,m)):m.isMeshDepthMaterial?r(p,m):m.isMeshDistanceMaterial?(r(p,m),y(p,m)):m.isMeshNormalMaterial?r(p,m):m.isLineBasicMaterial?(o(p,m),m.isLineDashedMaterial&&a(p,m)):m.isPointsMaterial?l(p,m,x,R):m.isSpriteMaterial?c(p,m):m.isShadowMaterial?(p.color.value.copy(m.color),p.opacity.value=m.opacity):m.isShaderMaterial&&(m.uniformsNeedUpdate=!1)}function r(p,m){p.opacity.value=m.opacity,m.color&&p.diffuse.value.copy(m.color),m.emissive&&p.emissive.value.copy(m.emissive).multiplyScalar(m.emissiveIntensity),m.map&&(p.map.value=m.map,t(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.bumpMap&&(p.bumpMap.value=m.bumpMap,t(m.bumpMap,p.bumpMapTransform),p.bumpScale.value=m.bumpScale,m.side===pi&&(p.bumpScale.value*=-1)),m.normalMap&&(p.normalMap.value=m.normalMap,t(m.normalMap,p.normalMapTransform),p.normalScale.value.copy(m.normalScale),m.side===pi&&p.normalScale.value.negate()),m.displacementMap&&(p.displacementMap.value=m.displacementMap,t(m.displacementMap,p.displacementMapTransform),p.displacementScale.value=m.displacementScale,p.displacementBias.value=m.displacementBias),m.emissiveMap&&(p.emissiveMap.value=m.emissiveMap,t(m.emissiveMap,p.emissiveMapTransform)),m.specularMap&&(p.specularMap.value=m.specularMap,t(m.specularMap,p.specularMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest);let x=e.get(m),R=x.envMap,S=x.envMapRotation;R&&(p.envMap.value=R,p.envMapRotation.value.setFromMatrix4(O1.makeRotationFromEuler(S)).transpose(),R.isCubeTexture&&R.isRenderTargetTexture===!1&&p.envMapRotation.value.premultiply(X_),p.reflectivity.value=m.reflectivity,p.ior.value=m.ior,p.refractionRatio.value=m.refractionRatio),m.lightMap&&(p.lightMap.value=m.lightMap,p.lightMapIntensity.value=m.lightMapIntensity,t(m.lightMap,p.lightMapTransform)),m.aoMap&&(p.aoMap.value=m.aoMap,p.aoMapIntensity.value=m.aoMapIntensity,t(m.aoMap,p.aoMapTransform))}function o(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,m.map&&(p.map.value=m.map,t(m.map,p.mapTransform))}function a(p,m){p.dashSize.value=m.dashSize,p.totalSize.value=m.dashSize+m.gapSize,p.scale.value=m.scale}function l(p,m,x,R){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.size.value=m.size*x,p.scale.value=R*.5,m.map&&(p.map.value=m.map,t(m.map,p.uvTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function c(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.rotation.value=m.rotation,m.map&&(p.map.value=m.map,t(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function u(p,m){p.specular.value.copy(m.specular),p.shininess.value=Math.max(m.shininess,1e-4)}function h(p,m){m.gradientMap&&(p.gradientMap.value=m.gradientMap)}function f(p,m){p.metalness.value=m.metalness,m.metalnessMap&&(p.metalnessMap.value=m.metalnessMap,t(m.metalnessMap,p.metalnessMapTransform)),p.roughness.value=m.roughness,m.roughnessMap&&(p.roughnessMap.value=m.roughnessMap,t(m.roughnessMap,p.roughnessMapTransform)),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)}function d(p,m,x){p.ior.value=m.ior,m.diffuseRoughness>0&&(p.diffuseRoughness.value=m.diffuseRoughness,m.diffuseRoughnessMap&&(p.diffuseRoughnessMap.value=m.diffuseRoughnessMap,t(m.diffuseRoughnessMap,p.diffuseRoughnessMapTransform))),m.sheen>0&&(p.sheenColor.value.copy(m.sheenColor).multiplyScalar(m.sheen),p.sheenRoughness.value=m.sheenRoughness,m.sheenColorMap&&(p.sheenColorMap.value=m.sheenColorMap,t(m.sheenColorMap,p.sheenColorMapTransform)),m.sheenRoughnessMap&&(p.sheenRoughnessMap.value=m.sheenRoughnessMap,t(m.sheenRoughnessMap,p.sheenRoughnessMapTransform))),m.clearcoat>0&&(p.clearcoat.value=m.clearcoat,p.clearcoatRoughness.value=m.clearcoatRoughness,m.clearcoatMap&&(p.clearcoatMap.value=m.clearcoatMap,t(m.clearcoatMap,p.clearcoatMapTransform)),m.clearcoatRoughnessMap&&(p.clearcoatRoughnessMap.value=m.clearcoatRoughnessMap,t(m.clearcoatRoughnessMap,p.clearcoatRoughnessMapTransform)),m.clearcoatNormalMap&&(p.clearcoatNormalMap.value=m.clearcoatNormalMap,t(m.clearcoatNormalMap,p.clearcoatNormalMapTransform),p.clearcoatNormalScale.value.copy(m.clearcoatNormalScale),m.side===pi&&p.clearcoatNormalScale.value.negate())),m.dispersion>0&&(p.dispersion.value=m.dispersion),m.retroreflectivity>0&&(p.retroreflectivity.value=m.retroreflectivity),m.iridescence>0&&(p.iridescence.value=m.iridescence,p.iridescenceIOR.value=m.iridescenceIOR,p.iridescenceThicknessMinimum.value=m.iridescenceThicknessMinimum,p.iridescenceThicknessMaximum.value=m.iridescenceThicknessMaximum,m.iridescenceMap&&(p.iridescenceMap.value=m.iridescenceMap,t(m.iridescenceMap,p.iridescenceMapTransform)),m.iridescenceThicknessMap&&(p.iridescenceThicknessMap.value=m.iridescenceThicknessMap,t(m.iridescenceThicknessMap,p.iridescenceThicknessMapTransform))),m.transmission>0&&(p.transmission.value=m.transmission,p.transmissionSamplerMap.value=x.texture,p.transmissionSamplerSize.value.set(x.width,x.height),m.transmissionMap&&(p.transmissionMap.value=m.transmissionMap,t(m.transmissionMap,p.transmissionMapTransform)),p.thickness.value=m.thickness,m.thicknessMap&&(p.thicknessMap.value=m.thicknessMap,t(m.thicknessMap,p.thicknessMapTransform)),p.attenuationDistance.value=m.attenuationDistance,p.attenuationColor.value.copy(m.attenuationColor)),m.anisotropy>0&&(p.anisotropyVector.value.set(m.anisotropy*Math.cos(m.anisotropyRotation),m.anisotropy*Math.sin(m.anisotropyRotation)),m.anisotropyMap&&(p.anisotropyMap.value=m.anisotropyMap,t(m.anisotropyMap,p.anisotropyMapTransform))),p.specularIntensity.value=m.specularIntensity,p.specularColor.value.copy(m.specularColor),m.specularColorMap&&(p.specularColorMap.value=m.specularColorMap,t(m.specularColorMap,p.specularColorMapTransform)),m.specularIntensityMap&&(p.specularIntensityMap.value=m.specularIntensityMap,t(m.specularIntensityMap,p.specularIntensityMapTransform))}function g(p,m){m.matcap&&(p.matcap.value=m.matcap)}function y(p,m){let x=e.get(m).light;p.referencePosition.value.setFromMatrixPosition(x.matrixWorld),p.nearDistance.value=x.shadow.camera.near,p.farDistance.value=x.shadow.camera.far}return{refreshFogUniforms:i,refreshMaterialUniforms:s}}function B1(n,e,t,i){let s={},r={};function o(x,R){let S=R.program;i.uniformBlockBinding(x,S,s[x.id])}function a(x,R){let S=s[x.id];S===void 0&&(g(x),S=l(x),s[x.id]=S,x.addEventListener("dispose",p));let C=R.program;i.updateUBOMapping(x,C);let E=e.render.frame;r[x.id]!==E&&(c(x),r[x.id]=E)}function l(x){let R=n.createBuffer(),S=x.__size,C=x.usage;return n.bindBuffer(n.UNIFORM_BUFFER,R),n.bufferData(n.UNIFORM_BUFFER,S,C),n.bindBuffer(n.UNIFORM_BUFFER,null),R}function c(x){let R=s[x.id],S=x.uniforms,C=x.__cache;n.bindBuffer(n.UNIFORM_BUFFER,R);for(let E=0,v=S.length;E<v;E++){let T=S[E];if(Array.isArray(T))for(let z=0,N=T.length;z<N;z++)u(T[z],E,z,C);else u(T,E,0,C)}n.bindBuffer(n.UNIFORM_BUFFER,null)}function u(x,R,S,C){if(f(x,R,S,C)===!0){let E=x.__offset,v=x.value;if(Array.isArray(v)){let T=0;for(let z=0;z<v.length;z++){let N=v[z],D=y(N,!0);h(N,x.__data,T),T+=D.storage/Float32Array.BYTES_PER_ELEMENT}}else h(v,x.__data,0);n.bufferSubData(n.UNIFORM_BUFFER,E,x.__data)}}function h(x,R,S){typeof x=="number"||typeof x=="boolean"?R[S]=x:x.isMatrix3?(R[S]=x.elements[0],R[S+1]=x.elements[1],R[S+2]=x.elements[2],R[S+3]=0,R[S+4]=x.elements[3],R[S+5]=x.elements[4],R[S+6]=x.elements[5],R[S+7]=0,R[S+8]=x.elements[6],R[S+9]=x.elements[7],R[S+10]=x.elements[8],R[S+11]=0):ArrayBuffer.isView(x)?R.set(x.subarray(0,R.length-S),S):x.toArray(R,S)}function f(x,R,S,C){let E=x.value,v=R+"_"+S;if(Array.isArray(E)){C[v]===void 0&&(C[v]=[]);let T=C[v],z=!1;for(let N=0;N<E.length;N++)d(E[N],T,N)===!0&&(z=!0);return z}return d(E,C,v)}function d(x,R,S){if(R[S]===void 0)return typeof x=="number"||typeof x=="boolean"?R[S]=x:ArrayBuffer.isView(x)?R[S]=x.slice():R[S]=x.clone(),!0;{let C=R[S];if(typeof x=="number"||typeof x=="boolean"){if(C!==x)return R[S]=x,!0}else{if(ArrayBuffer.isView(x))return!0;if(C.equals(x)===!1)return C.copy(x),!0}}return!1}function g(x){let R=x.uniforms,S=0,C=16;for(let v=0,T=R.length;v<T;v++){let z=Array.isArray(R[v])?R[v]:[R[v]];for(let N=0,D=z.length;N<D;N++){let W=z[N],G=Array.isArray(W.value)?W.value:[W.value],U=Array.isArray(R[v])||Array.isArray(W.value),X=S;for(let H=0,ce=G.length;H<ce;H++){let J=G[H],Q=y(J,U),se=S%C,fe=se%Q.boundary,he=se+fe;S+=fe,he!==0&&C-he<Q.storage&&(S+=C-he),H===0&&(X=S),S+=Q.storage}let K=W.type==="int"?Int32Array:W.type==="uint"?Uint32Array:Float32Array;W.__data=new K((S-X)/Float32Array.BYTES_PER_ELEMENT),W.__offset=X}}let E=S%C;return E>0&&(S+=C-E),x.__size=S,x.__cache={},this}function y(x,R){let S={boundary:0,storage:0};return typeof x=="number"||typeof x=="boolean"?(S.boundary=4,S.storage=4):x.isVector2?(S.boundary=8,S.storage=8):x.isVector3||x.isColor?(S.boundary=16,S.storage=12):x.isVector4?(S.boundary=16,S.storage=16):x.isMatrix3?(S.boundary=16,S.storage=48):x.isMatrix4?(S.boundary=16,S.storage=64):x.isTexture?Ye("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(x)?(S.boundary=16,S.storage=x.byteLength):Ye("WebGLRenderer: Unsupported uniform value type.",x),R===!0&&(S.boundary=16,S.storage=Math.ceil(S.storage/16)*16),S}function p(x){let R=x.target;R.removeEventListener("dispose",p),n.deleteBuffer(s[R.id]),delete s[R.id],delete r[R.id]}function m(){for(let x in s)n.deleteBuffer(s[x]);s={},r={}}return{bind:o,update:a,dispose:m}}var k1=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),Ts=null;function z1(){return Ts===null&&(Ts=new Qc(k1,16,16,Rr,rs),Ts.name="DFG_LUT",Ts.minFilter=fi,Ts.magFilter=fi,Ts.wrapS=Ss,Ts.wrapT=Ss,Ts.generateMipmaps=!1,Ts.needsUpdate=!0),Ts}var oh=class{constructor(e={}){let{canvas:t=s_(),context:i=null,depth:s=!0,stencil:r=!1,alpha:o=!1,antialias:a=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:u="default",failIfMajorPerformanceCaveat:h=!1,reversedDepthBuffer:f=!1,outputBufferType:d=Ii}=e;this.isWebGLRenderer=!0;let g;if(i!==null){if(typeof WebGLRenderingContext<"u"&&i instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");g=i.getContextAttributes().alpha}else g=o;let y=d,p=new Set([Au,Tu,wu]),m=new Set([Ii,is,ua,eo,Su,Mu]),x=new Uint32Array(4),R=new Int32Array(4),S={textures:[],min:[],max:[],resolution:[]},C=null,E=null,v=[],T=[],z=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=ws,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let N=this,D=!1,W=null,G=null,U=null,X=null;this._outputColorSpace=Ci;let K=0,H=0,ce=null,J=-1,Q=null,se=new rn,fe=new rn,he=null,ee=new yt(0),me=0,ve=t.width,Ee=t.height,Se=1,We=null,at=null,Ge=new rn(0,0,ve,Ee),dt=new rn(0,0,ve,Ee),ut=!1,st=new Kr,en=new eu,Xt=!1,dn=!1,kt=new Mt,Un=new V,At=new rn,An={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},on=!1;function pn(){return ce===null?Se:1}let F=i;function Re(w,B){return t.getContext(w,B)}let $e,lt,Me,Gt,Ve,qe,P,b,q,ue,oe,_e,xe,te,ie,pe,O,re,ne,we,ge,be,He;try{let w={alpha:!0,depth:s,stencil:r,antialias:a,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:u,failIfMajorPerformanceCaveat:h};if("setAttribute"in t&&t.setAttribute("data-engine",`three.js r${"187"}`),t.addEventListener("webglcontextlost",Be,!1),t.addEventListener("webglcontextrestored",je,!1),t.addEventListener("webglcontextcreationerror",Ce,!1),F===null){let B="webgl2";if(F=Re(B,w),F===null)throw Re(B)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}Je()}catch(w){throw t.removeEventListener("webglcontextlost",Be,!1),t.removeEventListener("webglcontextrestored",je,!1),t.removeEventListener("webglcontextcreationerror",Ce,!1),Qe("WebGLRenderer: "+w.message),w}function Je(){$e=new JM(F),$e.init(),ge=new D1(F,$e),lt=new zM(F,$e,e,ge),Me=new I1(F,$e),lt.reversedDepthBuffer&&f&&Me.buffers.depth.setReversed(!0),G=F.createFramebuffer(),U=F.createFramebuffer(),X=F.createFramebuffer(),Gt=new ew(F),Ve=new _1,qe=new L1(F,$e,Me,Ve,lt,ge,Gt),P=new KM(N),b=new nb(F),be=new BM(F,b),q=new jM(F,b,Gt,be),ue=new nw(F,q,b,be,Gt),re=new tw(F,lt,qe),ie=new VM(Ve),oe=new g1(N,P,$e,lt,be,ie),_e=new F1(N,Ve),xe=new x1,te=new T1($e),O=new FM(N,P,Me,ue,g,l),pe=new P1(N,ue,lt),He=new B1(F,Gt,lt,Me),ne=new kM(F,$e,Gt),we=new QM(F,$e,Gt),Gt.programs=oe.programs,N.capabilities=lt,N.extensions=$e,N.properties=Ve,N.renderLists=xe,N.shadowMap=pe,N.state=Me,N.info=Gt}y!==Ii&&(z=new sw(y,t.width,t.height,a,s,r));let le=new Gd(N,F);this.xr=le,this.getContext=function(){return F},this.getContextAttributes=function(){return F.getContextAttributes()},this.forceContextLoss=function(){let w=$e.get("WEBGL_lose_context");w&&w.loseContext()},this.forceContextRestore=function(){let w=$e.get("WEBGL_lose_context");w&&w.restoreContext()},this.getPixelRatio=function(){return Se},this.setPixelRatio=function(w){w!==void 0&&(Se=w,this.setSize(ve,Ee,!1))},this.getSize=function(w){return w.set(ve,Ee)},this.setSize=function(w,B,j=!0){if(le.isPresenting){Ye("WebGLRenderer: Can't change size while VR device is presenting.");return}ve=w,Ee=B,t.width=Math.floor(w*Se),t.height=Math.floor(B*Se),j===!0&&(t.style.width=w+"px",t.style.height=B+"px"),z!==null&&z.setSize(t.width,t.height),this.setViewport(0,0,w,B)},this.getDrawingBufferSize=function(w){return w.set(ve*Se,Ee*Se).floor()},this.setDrawingBufferSize=function(w,B,j){ve=w,Ee=B,Se=j,t.width=Math.floor(w*j),t.height=Math.floor(B*j),this.setViewport(0,0,w,B)},this.setEffects=function(w){if(y===Ii){Qe("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(w){for(let B=0;B<w.length;B++)if(w[B].isOutputPass===!0){Ye("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}z.setEffects(w||[])},this.getCurrentViewport=function(w){return w.copy(se)},this.getViewport=function(w){return w.copy(Ge)},this.setViewport=function(w,B,j,Y){w.isVector4?Ge.set(w.x,w.y,w.z,w.w):Ge.set(w,B,j,Y),Me.viewport(se.copy(Ge).multiplyScalar(pn()).round())},this.getScissor=function(w){return w.copy(dt)},this.setScissor=function(w,B,j,Y){w.isVector4?dt.set(w.x,w.y,w.z,w.w):dt.set(w,B,j,Y),Me.scissor(fe.copy(dt).multiplyScalar(pn()).round())},this.getScissorTest=function(){return ut},this.setScissorTest=function(w){Me.setScissorTest(ut=w)},this.setOpaqueSort=function(w){We=w},this.setTransparentSort=function(w){at=w},this.getClearColor=function(w){return w.copy(O.getClearColor())},this.setClearColor=function(){O.setClearColor(...arguments)},this.getClearAlpha=function(){return O.getClearAlpha()},this.setClearAlpha=function(){O.setClearAlpha(...arguments)},this.clear=function(w=!0,B=!0,j=!0){let Y=0;if(w){let $=!1;if(ce!==null){let Te=ce.texture.format;$=p.has(Te)}if($){let Te=ce.texture.type,Pe=m.has(Te),Ae=O.getClearColor(),Ie=O.getClearAlpha(),ze=Ae.r,et=Ae.g,pt=Ae.b;Pe?(x[0]=ze,x[1]=et,x[2]=pt,x[3]=Ie,F.clearBufferuiv(F.COLOR,0,x)):(R[0]=ze,R[1]=et,R[2]=pt,R[3]=Ie,F.clearBufferiv(F.COLOR,0,R))}else Y|=F.COLOR_BUFFER_BIT}B&&(Y|=F.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),j&&(Y|=F.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),Y!==0&&F.clear(Y)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(w){w.setRenderer(this),W=w},this.dispose=function(){t.removeEventListener("webglcontextlost",Be,!1),t.removeEventListener("webglcontextrestored",je,!1),t.removeEventListener("webglcontextcreationerror",Ce,!1),O.dispose(),xe.dispose(),te.dispose(),qe.dispose(),Ve.dispose(),P.dispose(),ue.dispose(),q.dispose(),be.dispose(),He.dispose(),oe.dispose(),le.dispose(),le.removeEventListener("sessionstart",Wl),le.removeEventListener("sessionend",ds),Ls.stop()};function Be(w){w.preventDefault(),wd("WebGLRenderer: Context Lost."),D=!0}function je(){wd("WebGLRenderer: Context Restored."),D=!1;let w=Gt.autoReset,B=pe.enabled,j=pe.autoUpdate,Y=pe.needsUpdate,$=pe.type;Je(),Gt.autoReset=w,pe.enabled=B,pe.autoUpdate=j,pe.needsUpdate=Y,pe.type=$}function Ce(w){Qe("WebGLRenderer: A WebGL context could not be created. Reason: ",w.statusMessage)}function ct(w){let B=w.target;B.removeEventListener("dispose",ct),qt(B)}function qt(w){si(w),Ve.remove(w)}function si(w){let B=Ve.get(w).programs;B!==void 0&&(B.forEach(function(j){oe.releaseProgram(j)}),w.isShaderMaterial&&oe.releaseShaderCache(w))}this.renderBufferDirect=function(w,B,j,Y,$,Te){B===null&&(B=An);let Pe=$.isMesh&&$.matrixWorld.determinantAffine()<0,Ae=Da(w,B,j,Y,$);Me.setMaterial(Y,Pe);let Ie=j.index,ze=1;if(Y.wireframe===!0){if(Ie=q.getWireframeAttribute(j),Ie===void 0)return;ze=2}let et=j.drawRange,pt=j.attributes.position,ke=et.start*ze,mt=(et.start+et.count)*ze;Te!==null&&(ke=Math.max(ke,Te.start*ze),mt=Math.min(mt,(Te.start+Te.count)*ze)),Ie!==null?(ke=Math.max(ke,0),mt=Math.min(mt,Ie.count)):pt!=null&&(ke=Math.max(ke,0),mt=Math.min(mt,pt.count));let sn=mt-ke;if(sn<0||sn===1/0)return;be.setup($,Y,Ae,j,Ie);let Ot,Ft=ne;if(Ie!==null&&(Ot=b.get(Ie),Ft=we,Ft.setIndex(Ot)),$.isMesh)Y.wireframe===!0?(Me.setLineWidth(Y.wireframeLinewidth*pn()),Ft.setMode(F.LINES)):Ft.setMode(F.TRIANGLES);else if($.isLine){let En=Y.linewidth;En===void 0&&(En=1),Me.setLineWidth(En*pn()),$.isLineSegments?Ft.setMode(F.LINES):$.isLineLoop?Ft.setMode(F.LINE_LOOP):Ft.setMode(F.LINE_STRIP)}else $.isPoints?Ft.setMode(F.POINTS):$.isSprite&&Ft.setMode(F.TRIANGLES);if($.isBatchedMesh)if($e.get("WEBGL_multi_draw"))Ft.renderMultiDraw($._multiDrawStarts,$._multiDrawCounts,$._multiDrawCount);else{let En=$._multiDrawStarts,Oe=$._multiDrawCounts,mn=$._multiDrawCount,St=Ie?b.get(Ie).bytesPerElement:1,Ns=Ve.get(Y).currentProgram.getUniforms();for(let gn=0;gn<mn;gn++)Ns.setValue(F,"_gl_DrawID",gn),Ft.render(En[gn]/St,Oe[gn])}else if($.isInstancedMesh)Ft.renderInstances(ke,sn,$.count);else if(j.isInstancedBufferGeometry){let En=j._maxInstanceCount!==void 0?j._maxInstanceCount:1/0,Oe=Math.min(j.instanceCount,En);Ft.renderInstances(ke,sn,Oe)}else Ft.render(ke,sn)};function Pa(w,B,j,Y){W!==null&&w.isNodeMaterial&&W.setObject(Y,w),Xt===!0&&ie.setState(w,j,!1),w.transparent===!0&&w.side===Ms&&w.forceSinglePass===!1?(w.side=pi,w.needsUpdate=!0,ps(w,B,Y),w.side=Cr,w.needsUpdate=!0,ps(w,B,Y),w.side=Ms):ps(w,B,Y)}this.compile=function(w,B,j=null){j===null&&(j=w),W!==null&&W.renderStart(w,B,j),E=te.get(j),E.init(B),T.push(E),j.traverseVisible(function($){$.isLight&&$.layers.test(B.layers)&&(E.pushLight($),$.castShadow&&E.pushShadow($))}),w!==j&&w.traverseVisible(function($){$.isLight&&$.layers.test(B.layers)&&(E.pushLight($),$.castShadow&&E.pushShadow($))}),E.setupLights(),W!==null&&W.updateLights(E.state.lightsArray),dn=this.localClippingEnabled,Xt=ie.init(this.clippingPlanes,dn),Xt===!0&&ie.setGlobalState(this.clippingPlanes,B),W!==null&&pe.render(E.state.shadowsArray,j,B);let Y=new Set;return w.traverse(function($){if(!($.isMesh||$.isPoints||$.isLine||$.isSprite))return;let Te=$.material;if(Te)if(Array.isArray(Te))for(let Pe=0;Pe<Te.length;Pe++){let Ae=Te[Pe];Pa(Ae,j,B,$),Y.add(Ae)}else Pa(Te,j,B,$),Y.add(Te)}),E=T.pop(),W!==null&&W.renderEnd(),Y},this.compileAsync=function(w,B,j=null){let Y=this.compile(w,B,j);return new Promise($=>{function Te(){if(Y.forEach(function(Pe){let Ie=Ve.get(Pe).currentProgram;(Ie===void 0||Ie.isReady())&&Y.delete(Pe)}),Y.size===0){$(w);return}setTimeout(Te,10)}$e.get("KHR_parallel_shader_compile")!==null?Te():setTimeout(Te,10)})};let xo=null;function Hh(w){xo&&xo(w)}function Wl(){Ls.stop()}function ds(){Ls.start()}let Ls=new U_;Ls.setAnimationLoop(Hh),typeof self<"u"&&Ls.setContext(self),this.setAnimationLoop=function(w){xo=w,le.setAnimationLoop(w),w===null?Ls.stop():Ls.start()},le.addEventListener("sessionstart",Wl),le.addEventListener("sessionend",ds),this.render=function(w,B){if(B!==void 0&&B.isCamera!==!0){Qe("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(D===!0)return;W!==null&&W.renderStart(w,B);let j=le.enabled===!0&&le.isPresenting===!0,Y=z!==null&&(ce===null||j)&&z.begin(N,ce);if(w.matrixWorldAutoUpdate===!0&&w.updateMatrixWorld(),B.parent===null&&B.matrixWorldAutoUpdate===!0&&B.updateMatrixWorld(),le.enabled===!0&&le.isPresenting===!0&&(z===null||z.isCompositing()===!1)&&(le.cameraAutoUpdate===!0&&le.updateCamera(B),B=le.getCamera()),w.isScene===!0&&w.onBeforeRender(N,w,B,ce),E=te.get(w,T.length),E.init(B),E.state.textureUnits=qe.getTextureUnits(),T.push(E),kt.multiplyMatrices(B.projectionMatrix,B.matrixWorldInverse),B.isArrayCamera?en.setFromArrayCamera(B):st.setFromProjectionMatrix(kt,ki,B.reversedDepth),dn=this.localClippingEnabled,Xt=ie.init(this.clippingPlanes,dn),C=xe.get(w,v.length),C.init(),v.push(C),this.info.render.frame++,le.enabled===!0&&le.isPresenting===!0){let Pe=N.xr.getDepthSensingMesh();Pe!==null&&Ds(Pe,B,-1/0,N.sortObjects)}Ds(w,B,0,N.sortObjects),C.finish(),W!==null&&W.updateLights(E.state.lightsArray),N.sortObjects===!0&&C.sort(We,at),on=le.enabled===!1||le.isPresenting===!1||le.hasDepthSensing()===!1,on&&O.addToRenderList(C,w),this.info.autoReset===!0&&this.info.reset(),Xt===!0&&ie.beginShadows();let $=E.state.shadowsArray;if(pe.render($,w,B),Xt===!0&&ie.endShadows(),(Y&&z.hasRenderPass())===!1){let Pe=C.opaque,Ae=C.transmissive;if(E.setupLights(),B.isArrayCamera){let Ie=B.cameras;if(Ae.length>0)for(let ze=0,et=Ie.length;ze<et;ze++){let pt=Ie[ze];qi(Pe,Ae,w,pt)}on&&O.render(w);for(let ze=0,et=Ie.length;ze<et;ze++){let pt=Ie[ze];Ia(C,w,pt,pt.viewport)}}else Ae.length>0&&qi(Pe,Ae,w,B),on&&O.render(w),Ia(C,w,B)}ce!==null&&H===0&&(qe.updateMultisampleRenderTarget(ce),qe.updateRenderTargetMipmap(ce)),Y&&z.end(N),w.isScene===!0&&w.onAfterRender(N,w,B),be.resetDefaultState(),J=-1,Q=null,T.pop(),T.length>0?(E=T[T.length-1],qe.setTextureUnits(E.state.textureUnits),Xt===!0&&ie.setGlobalState(N.clippingPlanes,E.state.camera)):E=null,v.pop(),v.length>0?C=v[v.length-1]:C=null,W!==null&&W.renderEnd()};function Ds(w,B,j,Y){if(w.visible===!1)return;if(w.layers.test(B.layers)){if(w.isGroup)j=w.renderOrder;else if(w.isLOD)w.autoUpdate===!0&&w.update(B);else if(w.isLight)E.pushLight(w),w.castShadow&&E.pushShadow(w);else if(w.isSprite){let Pe=B.isArrayCamera?en:st;if(!w.frustumCulled||w.intersectsFrustum(Pe)){Y&&At.setFromMatrixPosition(w.matrixWorld).applyMatrix4(kt);let Ae=ue.update(w),Ie=w.material;Ie.visible&&C.push(w,Ae,Ie,j,At.z,null,B)}}else if(w.isMesh||w.isLine||w.isPoints){let Pe=B.isArrayCamera?en:st;if(!w.frustumCulled||w.intersectsFrustum(Pe)){let Ae=ue.update(w),Ie=w.material;if(Y&&(w.boundingSphere!==void 0?(w.boundingSphere===null&&w.computeBoundingSphere(),At.copy(w.boundingSphere.center)):(Ae.boundingSphere===null&&Ae.computeBoundingSphere(),At.copy(Ae.boundingSphere.center)),At.applyMatrix4(w.matrixWorld).applyMatrix4(kt)),Array.isArray(Ie)){let ze=Ae.groups;for(let et=0,pt=ze.length;et<pt;et++){let ke=ze[et],mt=Ie[ke.materialIndex];mt&&mt.visible&&C.push(w,Ae,mt,j,At.z,ke,B)}}else Ie.visible&&C.push(w,Ae,Ie,j,At.z,null,B)}}}let Te=w.children;for(let Pe=0,Ae=Te.length;Pe<Ae;Pe++)Ds(Te[Pe],B,j,Y)}function Ia(w,B,j,Y){let{opaque:$,transmissive:Te,transparent:Pe}=w;E.setupLightsView(j),Xt===!0&&ie.setGlobalState(N.clippingPlanes,j),Y&&Me.viewport(se.copy(Y)),$.length>0&&an($,B,j),Te.length>0&&an(Te,B,j),Pe.length>0&&an(Pe,B,j),Me.buffers.depth.setTest(!0),Me.buffers.depth.setMask(!0),Me.buffers.color.setMask(!0),Me.setPolygonOffset(!1)}function qi(w,B,j,Y){if((j.isScene===!0?j.overrideMaterial:null)!==null)return;if(E.state.transmissionRenderTarget[Y.id]===void 0){let ke=$e.has("EXT_color_buffer_half_float")||$e.has("EXT_color_buffer_float");E.state.transmissionRenderTarget[Y.id]=new Ri(1,1,{generateMipmaps:!0,type:ke?rs:Ii,minFilter:Ks,samples:Math.max(4,lt.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:_t.workingColorSpace})}let Te=E.state.transmissionRenderTarget[Y.id],Pe=Y.viewport||se;Te.setSize(Pe.z*N.transmissionResolutionScale,Pe.w*N.transmissionResolutionScale);let Ae=N.getRenderTarget(),Ie=N.getActiveCubeFace(),ze=N.getActiveMipmapLevel();N.setRenderTarget(Te),N.getClearColor(ee),me=N.getClearAlpha(),me<1&&N.setClearColor(16777215,.5),N.clear(),on&&O.render(j);let et=N.toneMapping;N.toneMapping=ws;let pt=Y.viewport;if(Y.viewport!==void 0&&(Y.viewport=void 0),E.setupLightsView(Y),Xt===!0&&ie.setGlobalState(N.clippingPlanes,Y),an(w,j,Y),qe.updateMultisampleRenderTarget(Te),qe.updateRenderTargetMipmap(Te),$e.has("WEBGL_multisampled_render_to_texture")===!1){let ke=!1;for(let mt=0,sn=B.length;mt<sn;mt++){let Ot=B[mt],{object:Ft,geometry:En,material:Oe,group:mn}=Ot;if(Oe.side===Ms&&Ft.layers.test(Y.layers)){let St=Oe.side;Oe.side=pi,Oe.needsUpdate=!0,hn(Ft,j,Y,En,Oe,mn),Oe.side=St,Oe.needsUpdate=!0,ke=!0}}ke===!0&&(qe.updateMultisampleRenderTarget(Te),qe.updateRenderTargetMipmap(Te))}N.setRenderTarget(Ae,Ie,ze),N.setClearColor(ee,me),pt!==void 0&&(Y.viewport=pt),N.toneMapping=et}function an(w,B,j){let Y=B.isScene===!0?B.overrideMaterial:null;for(let $=0,Te=w.length;$<Te;$++){let Pe=w[$],{object:Ae,geometry:Ie,group:ze}=Pe,et=Pe.material;et.allowOverride===!0&&Y!==null&&(et=Y),Ae.layers.test(j.layers)&&hn(Ae,B,j,Ie,et,ze)}}function hn(w,B,j,Y,$,Te){W!==null&&$.isNodeMaterial&&W.setObject(w,$),w.onBeforeRender(N,B,j,Y,$,Te),w.modelViewMatrix.multiplyMatrices(j.matrixWorldInverse,w.matrixWorld),w.normalMatrix.getNormalMatrix(w.modelViewMatrix),$.onBeforeRender(N,B,j,Y,w,Te),$.transparent===!0&&$.side===Ms&&$.forceSinglePass===!1?($.side=pi,$.needsUpdate=!0,N.renderBufferDirect(j,B,Y,$,w,Te),$.side=Cr,$.needsUpdate=!0,N.renderBufferDirect(j,B,Y,$,w,Te),$.side=Ms):N.renderBufferDirect(j,B,Y,$,w,Te),w.onAfterRender(N,B,j,Y,$,Te)}function fn(w){let B=0;for(let j of w)j.texture!==null&&B++;return B}function ps(w,B,j){B.isScene!==!0&&(B=An);let Y=Ve.get(w),$=E.state.lights,Te=E.state.shadowsArray,Pe=$.state.version,Ae=oe.getParameters(w,$.state,Te,B,j,E.state.lightProbeGridArray),Ie=oe.getProgramCacheKey(Ae),ze=Y.programs;Y.environment=w.isMeshStandardMaterial||w.isMeshLambertMaterial||w.isMeshPhongMaterial?B.environment:null,Y.fog=B.fog;let et=w.isMeshStandardMaterial||w.isMeshLambertMaterial&&!w.envMap||w.isMeshPhongMaterial&&!w.envMap;Y.envMap=P.get(w.envMap||Y.environment,et),Y.envMapRotation=Y.environment!==null&&w.envMap===null?B.environmentRotation:w.envMapRotation,ze===void 0&&(w.addEventListener("dispose",ct),ze=new Map,Y.programs=ze,Y.programVariants=new Map);let pt=ze.get(Ie);if(pt!==void 0){if(Y.currentProgram===pt&&Y.lightsStateVersion===Pe)return La(w,Ae),pt}else Ae.uniforms=oe.getUniforms(w),W!==null&&w.isNodeMaterial&&W.build(w,j,Ae),w.onBeforeCompile(Ae,N),pt=oe.acquireProgram(Ae,Ie),ze.set(Ie,pt),Y.uniforms=Ae.uniforms;let ke=Y.uniforms;return(!w.isShaderMaterial&&!w.isRawShaderMaterial||w.clipping===!0)&&(ke.clippingPlanes=ie.uniform),La(w,Ae),Y.needsLights=or(w),Y.lightsStateVersion=Pe,Y.needsLights&&(ke.ambientLightColor.value=$.state.ambient,ke.lightProbe.value=$.state.probe,ke.sunLights.value=$.state.sun,ke.sunLightShadows.value=$.state.sunShadow,ke.directionalLights.value=$.state.directional,ke.directionalLightShadows.value=$.state.directionalShadow,ke.spotLights.value=$.state.spot,ke.spotLightShadows.value=$.state.spotShadow,ke.rectAreaLights.value=$.state.rectArea,ke.ltc_1.value=$.state.rectAreaLTC1,ke.ltc_2.value=$.state.rectAreaLTC2,ke.pointLights.value=$.state.point,ke.pointLightShadows.value=$.state.pointShadow,ke.hemisphereLights.value=$.state.hemi,ke.sunShadowMatrix.value=$.state.sunShadowMatrix,ke.sunShadowCascade.value=$.state.sunShadowCascade,ke.directionalShadowMatrix.value=$.state.directionalShadowMatrix,ke.spotLightMatrix.value=$.state.spotLightMatrix,ke.spotLightMap.value=$.state.spotLightMap,ke.pointShadowMatrix.value=$.state.pointShadowMatrix),Y.numLightProbeGrids=fn(E.state.lightProbeGridArray),Y.currentProgram=pt,Y.uniformsList=null,pt}function Si(w,B,j,Y,$){let Te=Ve.get(w),Pe=Te.currentProgram.id+","+Y+","+$,Ae=Te.programVariants.get(Pe);return Ae===void 0?(Ae=ps(w,B,j),Te.programVariants.set(Pe,Ae)):(Te.currentProgram=Ae,Te.uniformsList=null,Te.outputColorSpace=Y,Te.toneMapping=$),Ae}function rr(w){if(w.uniformsList===null){let B=w.currentProgram.getUniforms();w.uniformsList=fa.seqWithValue(B.seq,w.uniforms)}return w.uniformsList}function La(w,B){let j=Ve.get(w);j.outputColorSpace=B.outputColorSpace,j.batching=B.batching,j.batchingColor=B.batchingColor,j.instancing=B.instancing,j.instancingColor=B.instancingColor,j.instancingMorph=B.instancingMorph,j.skinning=B.skinning,j.morphTargets=B.morphTargets,j.morphNormals=B.morphNormals,j.morphColors=B.morphColors,j.morphTargetsCount=B.morphTargetsCount,j.numClippingPlanes=B.numClippingPlanes,j.numIntersection=B.numClipIntersection,j.vertexAlphas=B.vertexAlphas,j.vertexTangents=B.vertexTangents,j.toneMapping=B.toneMapping}function Da(w,B,j,Y,$){B.isScene!==!0&&(B=An),qe.resetTextureUnits();let Te=B.fog,Pe=Y.isMeshStandardMaterial||Y.isMeshLambertMaterial||Y.isMeshPhongMaterial?B.environment:null,Ae=ce===null?N.outputColorSpace:ce.isXRRenderTarget===!0?ce.texture.colorSpace:_t.workingColorSpace,Ie=Y.isMeshStandardMaterial||Y.isMeshLambertMaterial&&!Y.envMap||Y.isMeshPhongMaterial&&!Y.envMap,ze=P.get(Y.envMap||Pe,Ie),et=Y.vertexColors===!0&&!!j.attributes.color&&j.attributes.color.itemSize===4,pt=!!j.attributes.tangent&&(!!Y.normalMap||Y.anisotropy>0),ke=!!j.morphAttributes.position,mt=!!j.morphAttributes.normal,sn=!!j.morphAttributes.color,Ot=ws;Y.toneMapped&&(ce===null||ce.isXRRenderTarget===!0)&&(Ot=N.toneMapping);let Ft=j.morphAttributes.position||j.morphAttributes.normal||j.morphAttributes.color,En=Ft!==void 0?Ft.length:0,Oe=Ve.get(Y),mn=E.state.lights;if(Xt===!0&&(dn===!0||w!==Q)){let Bt=w===Q&&Y.id===J;ie.setState(Y,w,Bt)}let St=!1,Ns=!1;Y.version===Oe.__version?Oe.needsLights&&Oe.lightsStateVersion!==mn.state.version||$.isBatchedMesh&&Oe.batching===!1||!$.isBatchedMesh&&Oe.batching===!0||$.isBatchedMesh&&Oe.batchingColor===!0&&$._colorsTexture===null||$.isBatchedMesh&&Oe.batchingColor===!1&&$._colorsTexture!==null||$.isInstancedMesh&&Oe.instancing===!1||!$.isInstancedMesh&&Oe.instancing===!0||$.isSkinnedMesh&&Oe.skinning===!1||!$.isSkinnedMesh&&Oe.skinning===!0||$.isInstancedMesh&&Oe.instancingColor===!0&&$.instanceColor===null||$.isInstancedMesh&&Oe.instancingColor===!1&&$.instanceColor!==null||$.isInstancedMesh&&Oe.instancingMorph===!0&&$.morphTexture===null||$.isInstancedMesh&&Oe.instancingMorph===!1&&$.morphTexture!==null||Oe.envMap!==ze||Y.fog===!0&&Oe.fog!==Te||Oe.numClippingPlanes!==void 0&&(Oe.numClippingPlanes!==ie.numPlanes||Oe.numIntersection!==ie.numIntersection)||Oe.vertexAlphas!==et||Oe.vertexTangents!==pt||Oe.morphTargets!==ke||Oe.morphNormals!==mt||Oe.morphColors!==sn||Oe.morphTargetsCount!==En||Oe.numLightProbeGrids!==fn(E.state.lightProbeGridArray)?St=!0:(Oe.outputColorSpace!==Ae||Oe.toneMapping!==Ot)&&(Ns=!0):(St=!0,Oe.__version=Y.version);let gn=Oe.currentProgram;(St===!0||Ns===!0)&&(gn=Ns===!0?Si(Y,B,$,Ae,Ot):ps(Y,B,$),W&&Y.isNodeMaterial&&W.onUpdateProgram(Y,gn,Oe));let So=!1,ms=!1,Us=!1,ht=gn.getUniforms(),ln=Oe.uniforms;if(Me.useProgram(gn.program)&&(So=!0,ms=!0,Us=!0),Y.id!==J&&(J=Y.id,ms=!0),So||Q!==w){Me.buffers.depth.getReversed()&&w.reversedDepth!==!0&&(w._reversedDepth=!0,w.updateProjectionMatrix()),ht.setValue(F,"projectionMatrix",w.projectionMatrix),ht.setValue(F,"viewMatrix",w.matrixWorldInverse);let _n=ht.map.cameraPosition;_n!==void 0&&_n.setValue(F,Un.setFromMatrixPosition(w.matrixWorld)),lt.logarithmicDepthBuffer&&ht.setValue(F,"logDepthBufFC",2/(Math.log(w.far+1)/Math.LN2)),(Y.isMeshPhongMaterial||Y.isMeshToonMaterial||Y.isMeshLambertMaterial||Y.isMeshBasicMaterial||Y.isMeshStandardMaterial||Y.isShaderMaterial)&&ht.setValue(F,"isOrthographic",w.isOrthographicCamera===!0),Q!==w&&(Q=w,ms=!0,Us=!0)}if(Oe.needsLights&&(mn.state.sunShadowMap.length>0&&ht.setValue(F,"sunShadowMap",mn.state.sunShadowMap,qe),mn.state.directionalShadowMap.length>0&&ht.setValue(F,"directionalShadowMap",mn.state.directionalShadowMap,qe),mn.state.spotShadowMap.length>0&&ht.setValue(F,"spotShadowMap",mn.state.spotShadowMap,qe),mn.state.pointShadowMap.length>0&&ht.setValue(F,"pointShadowMap",mn.state.pointShadowMap,qe)),$.isSkinnedMesh){ht.setOptional(F,$,"bindMatrix"),ht.setOptional(F,$,"bindMatrixInverse");let Bt=$.skeleton;Bt&&(Bt.boneTexture===null&&Bt.computeBoneTexture(),ht.setValue(F,"boneTexture",Bt.boneTexture,qe))}$.isBatchedMesh&&(ht.setOptional(F,$,"batchingTexture"),ht.setValue(F,"batchingTexture",$._matricesTexture,qe),ht.setOptional(F,$,"batchingIdTexture"),ht.setValue(F,"batchingIdTexture",$._indirectTexture,qe),ht.setOptional(F,$,"batchingColorTexture"),$._colorsTexture!==null&&ht.setValue(F,"batchingColorTexture",$._colorsTexture,qe));let ri=j.morphAttributes;if((ri.position!==void 0||ri.normal!==void 0||ri.color!==void 0)&&re.update($,j,gn),(ms||Oe.receiveShadow!==$.receiveShadow)&&(Oe.receiveShadow=$.receiveShadow,ht.setValue(F,"receiveShadow",$.receiveShadow)),(Y.isMeshStandardMaterial||Y.isMeshLambertMaterial||Y.isMeshPhongMaterial)&&Y.envMap===null&&B.environment!==null&&(ln.envMapIntensity.value=B.environmentIntensity),ln.dfgLUT!==void 0&&(ln.dfgLUT.value=z1()),ms){if(ht.setValue(F,"toneMappingExposure",N.toneMappingExposure),Oe.needsLights&&yo(ln,Us),Te&&Y.fog===!0&&_e.refreshFogUniforms(ln,Te),_e.refreshMaterialUniforms(ln,Y,Se,Ee,E.state.transmissionRenderTarget[w.id]),Oe.needsLights&&Oe.numLightProbeGrids>0){let Bt=S,_n=0;for(let $n of E.state.lightProbeGridArray)$n.texture!==null&&(Bt.textures[_n]=$n.texture,Bt.min[_n]=$n.boundingBox.min,Bt.max[_n]=$n.boundingBox.max,Bt.resolution[_n]=$n.resolution,_n++);for(let $n in Bt)Bt[$n].length=_n;ln.probesSH.value=Bt.textures,ln.probesMin.value=Bt.min,ln.probesMax.value=Bt.max,ln.probesResolution.value=Bt.resolution}fa.upload(F,rr(Oe),ln,qe)}if(Y.isShaderMaterial&&Y.uniformsNeedUpdate===!0&&(fa.upload(F,rr(Oe),ln,qe),Y.uniformsNeedUpdate=!1),Y.isSpriteMaterial&&ht.setValue(F,"center",$.center),ht.setValue(F,"modelViewMatrix",$.modelViewMatrix),ht.setValue(F,"normalMatrix",$.normalMatrix),ht.setValue(F,"modelMatrix",$.matrixWorld),Y.uniformsGroups!==void 0){let Bt=Y.uniformsGroups;for(let _n=0,$n=Bt.length;_n<$n;_n++){let Xl=Bt[_n];He.update(Xl,gn),He.bind(Xl,gn)}}return gn}function yo(w,B){w.ambientLightColor.needsUpdate=B,w.lightProbe.needsUpdate=B,w.sunLights.needsUpdate=B,w.sunLightShadows.needsUpdate=B,w.directionalLights.needsUpdate=B,w.directionalLightShadows.needsUpdate=B,w.pointLights.needsUpdate=B,w.pointLightShadows.needsUpdate=B,w.spotLights.needsUpdate=B,w.spotLightShadows.needsUpdate=B,w.rectAreaLights.needsUpdate=B,w.hemisphereLights.needsUpdate=B}function or(w){return w.isMeshLambertMaterial||w.isMeshToonMaterial||w.isMeshPhongMaterial||w.isMeshStandardMaterial||w.isShadowMaterial||w.isShaderMaterial&&w.lights===!0}this.getActiveCubeFace=function(){return K},this.getActiveMipmapLevel=function(){return H},this.getRenderTarget=function(){return ce},this.setRenderTargetTextures=function(w,B,j){let Y=Ve.get(w);Y.__autoAllocateDepthBuffer=w.resolveDepthBuffer===!1,Y.__autoAllocateDepthBuffer===!1&&(Y.__useRenderToTexture=!1),Ve.get(w.texture).__webglTexture=B,Ve.get(w.depthTexture).__webglTexture=Y.__autoAllocateDepthBuffer?void 0:j,Y.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(w,B){let j=Ve.get(w);j.__webglFramebuffer=B,j.__useDefaultFramebuffer=B===void 0},this.setRenderTarget=function(w,B=0,j=0){ce=w,K=B,H=j;let Y=null,$=!1,Te=!1;if(w){let Ae=Ve.get(w);if(Ae.__useDefaultFramebuffer!==void 0){Me.bindFramebuffer(F.FRAMEBUFFER,Ae.__webglFramebuffer),se.copy(w.viewport),fe.copy(w.scissor),he=w.scissorTest,Me.viewport(se),Me.scissor(fe),Me.setScissorTest(he),J=-1;return}else if(Ae.__webglFramebuffer===void 0)qe.setupRenderTarget(w);else if(Ae.__hasExternalTextures)qe.rebindTextures(w,Ve.get(w.texture).__webglTexture,Ve.get(w.depthTexture).__webglTexture);else if(w.depthBuffer){let et=w.depthTexture;if(Ae.__boundDepthTexture!==et){if(et!==null&&Ve.has(et)&&(w.width!==et.image.width||w.height!==et.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");qe.setupDepthRenderbuffer(w)}}let Ie=w.texture;(Ie.isData3DTexture||Ie.isDataArrayTexture||Ie.isCompressedArrayTexture)&&(Te=!0);let ze=Ve.get(w).__webglFramebuffer;w.isWebGLCubeRenderTarget?(Array.isArray(ze[B])?Y=ze[B][j]:Y=ze[B],$=!0):w.samples>0&&qe.useMultisampledRTT(w)===!1?Y=Ve.get(w).__webglMultisampledFramebuffer:Array.isArray(ze)?Y=ze[j]:Y=ze,se.copy(w.viewport),fe.copy(w.scissor),he=w.scissorTest}else se.copy(Ge).multiplyScalar(Se).floor(),fe.copy(dt).multiplyScalar(Se).floor(),he=ut;if(j!==0&&(Y=G),Me.bindFramebuffer(F.FRAMEBUFFER,Y)&&Me.drawBuffers(w,Y),Me.viewport(se),Me.scissor(fe),Me.setScissorTest(he),$){let Ae=Ve.get(w.texture);F.framebufferTexture2D(F.FRAMEBUFFER,F.COLOR_ATTACHMENT0,F.TEXTURE_CUBE_MAP_POSITIVE_X+B,Ae.__webglTexture,j)}else if(Te){let Ae=B;for(let Ie=0;Ie<w.textures.length;Ie++){let ze=Ve.get(w.textures[Ie]);F.framebufferTextureLayer(F.FRAMEBUFFER,F.COLOR_ATTACHMENT0+Ie,ze.__webglTexture,j,Ae)}}else if(w!==null&&j!==0){let Ae=Ve.get(w.texture);F.framebufferTexture2D(F.FRAMEBUFFER,F.COLOR_ATTACHMENT0,F.TEXTURE_2D,Ae.__webglTexture,j)}J=-1};function bo(w){let B=Ve.get(w);return(B.__readFormat!==w.format||B.__readType!==w.type)&&(B.__readFormat=w.format,B.__readType=w.type,B.__formatReadable=lt.textureFormatReadable(w.format),B.__typeReadable=lt.textureTypeReadable(w.type)),B}this.readRenderTargetPixels=function(w,B,j,Y,$,Te,Pe,Ae=0){if(!(w&&w.isWebGLRenderTarget)){Qe("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Ie=Ve.get(w).__webglFramebuffer;if(w.isWebGLCubeRenderTarget&&Pe!==void 0&&(Ie=Ie[Pe],Array.isArray(Ie)&&(Ie=Ie[0])),Ie){Me.bindFramebuffer(F.FRAMEBUFFER,Ie);try{let ze=w.textures[Ae],et=ze.format,pt=ze.type;w.textures.length>1&&F.readBuffer(F.COLOR_ATTACHMENT0+Ae);let ke=bo(ze);if(ke.__formatReadable===!1){Qe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(ke.__typeReadable===!1){Qe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}B>=0&&B<=w.width-Y&&j>=0&&j<=w.height-$&&F.readPixels(B,j,Y,$,ge.convert(et),ge.convert(pt),Te)}finally{let ze=ce!==null?Ve.get(ce).__webglFramebuffer:null;Me.bindFramebuffer(F.FRAMEBUFFER,ze)}}},this.readRenderTargetPixelsAsync=async function(w,B,j,Y,$,Te,Pe,Ae=0){if(!(w&&w.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Ie=Ve.get(w).__webglFramebuffer;if(w.isWebGLCubeRenderTarget&&Pe!==void 0&&(Ie=Ie[Pe],Array.isArray(Ie)&&(Ie=Ie[0])),Ie)if(B>=0&&B<=w.width-Y&&j>=0&&j<=w.height-$){Me.bindFramebuffer(F.FRAMEBUFFER,Ie);let ze=w.textures[Ae],et=ze.format,pt=ze.type;w.textures.length>1&&F.readBuffer(F.COLOR_ATTACHMENT0+Ae);let ke=bo(ze);if(ke.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(ke.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let mt=F.createBuffer();F.bindBuffer(F.PIXEL_PACK_BUFFER,mt),F.bufferData(F.PIXEL_PACK_BUFFER,Te.byteLength,F.STREAM_READ),F.readPixels(B,j,Y,$,ge.convert(et),ge.convert(pt),0),F.bindBuffer(F.PIXEL_PACK_BUFFER,null);let sn=ce!==null?Ve.get(ce).__webglFramebuffer:null;Me.bindFramebuffer(F.FRAMEBUFFER,sn);let Ot=F.fenceSync(F.SYNC_GPU_COMMANDS_COMPLETE,0);return F.flush(),await o_(F,Ot,4),F.bindBuffer(F.PIXEL_PACK_BUFFER,mt),F.getBufferSubData(F.PIXEL_PACK_BUFFER,0,Te),F.bindBuffer(F.PIXEL_PACK_BUFFER,null),F.deleteBuffer(mt),F.deleteSync(Ot),Te}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(w,B=null,j=0){let Y=Math.pow(2,-j),$=Math.floor(w.image.width*Y),Te=Math.floor(w.image.height*Y),Pe=B!==null?B.x:0,Ae=B!==null?B.y:0;qe.setTexture2D(w,0),F.copyTexSubImage2D(F.TEXTURE_2D,j,0,0,Pe,Ae,$,Te),Me.unbindTexture()},this.copyTextureToTexture=function(w,B,j=null,Y=null,$=0,Te=0){let Pe,Ae,Ie,ze,et,pt,ke,mt,sn,Ot=w.isCompressedTexture?w.mipmaps[Te]:w.image;if(j!==null)Pe=j.max.x-j.min.x,Ae=j.max.y-j.min.y,Ie=j.isBox3?j.max.z-j.min.z:1,ze=j.min.x,et=j.min.y,pt=j.isBox3?j.min.z:0;else{let ht=Math.pow(2,-$);Pe=Math.floor(Ot.width*ht),Ae=Math.floor(Ot.height*ht),w.isDataArrayTexture?Ie=Ot.depth:w.isData3DTexture?Ie=Math.floor(Ot.depth*ht):Ie=1,ze=0,et=0,pt=0}Y!==null?(ke=Y.x,mt=Y.y,sn=Y.z):(ke=0,mt=0,sn=0);let Ft=ge.convert(B.format),En=ge.convert(B.type),Oe;B.isData3DTexture?(qe.setTexture3D(B,0),Oe=F.TEXTURE_3D):B.isDataArrayTexture||B.isCompressedArrayTexture?(qe.setTexture2DArray(B,0),Oe=F.TEXTURE_2D_ARRAY):(qe.setTexture2D(B,0),Oe=F.TEXTURE_2D),Me.activeTexture(F.TEXTURE0),Me.pixelStorei(F.UNPACK_FLIP_Y_WEBGL,B.flipY),Me.pixelStorei(F.UNPACK_PREMULTIPLY_ALPHA_WEBGL,B.premultiplyAlpha),Me.pixelStorei(F.UNPACK_ALIGNMENT,B.unpackAlignment);let mn=Me.getParameter(F.UNPACK_ROW_LENGTH),St=Me.getParameter(F.UNPACK_IMAGE_HEIGHT),Ns=Me.getParameter(F.UNPACK_SKIP_PIXELS),gn=Me.getParameter(F.UNPACK_SKIP_ROWS),So=Me.getParameter(F.UNPACK_SKIP_IMAGES);Me.pixelStorei(F.UNPACK_ROW_LENGTH,Ot.width),Me.pixelStorei(F.UNPACK_IMAGE_HEIGHT,Ot.height),Me.pixelStorei(F.UNPACK_SKIP_PIXELS,ze),Me.pixelStorei(F.UNPACK_SKIP_ROWS,et),Me.pixelStorei(F.UNPACK_SKIP_IMAGES,pt);let ms=w.isDataArrayTexture||w.isData3DTexture,Us=B.isDataArrayTexture||B.isData3DTexture;if(w.isDepthTexture){let ht=Ve.get(w),ln=Ve.get(B),ri=Ve.get(ht.__renderTarget),Bt=Ve.get(ln.__renderTarget);Me.bindFramebuffer(F.READ_FRAMEBUFFER,ri.__webglFramebuffer),Me.bindFramebuffer(F.DRAW_FRAMEBUFFER,Bt.__webglFramebuffer);for(let _n=0;_n<Ie;_n++)ms&&(F.framebufferTextureLayer(F.READ_FRAMEBUFFER,F.COLOR_ATTACHMENT0,Ve.get(w).__webglTexture,$,pt+_n),F.framebufferTextureLayer(F.DRAW_FRAMEBUFFER,F.COLOR_ATTACHMENT0,Ve.get(B).__webglTexture,Te,sn+_n)),F.blitFramebuffer(ze,et,ze+Pe,et+Ae,ke,mt,ke+Pe,mt+Ae,F.DEPTH_BUFFER_BIT,F.NEAREST);Me.bindFramebuffer(F.READ_FRAMEBUFFER,null),Me.bindFramebuffer(F.DRAW_FRAMEBUFFER,null)}else if($!==0||w.isRenderTargetTexture||Ve.has(w)){let ht=Ve.get(w),ln=Ve.get(B);Me.bindFramebuffer(F.READ_FRAMEBUFFER,U),Me.bindFramebuffer(F.DRAW_FRAMEBUFFER,X);for(let ri=0;ri<Ie;ri++)ms?F.framebufferTextureLayer(F.READ_FRAMEBUFFER,F.COLOR_ATTACHMENT0,ht.__webglTexture,$,pt+ri):F.framebufferTexture2D(F.READ_FRAMEBUFFER,F.COLOR_ATTACHMENT0,F.TEXTURE_2D,ht.__webglTexture,$),Us?F.framebufferTextureLayer(F.DRAW_FRAMEBUFFER,F.COLOR_ATTACHMENT0,ln.__webglTexture,Te,sn+ri):F.framebufferTexture2D(F.DRAW_FRAMEBUFFER,F.COLOR_ATTACHMENT0,F.TEXTURE_2D,ln.__webglTexture,Te),$!==0?F.blitFramebuffer(ze,et,ze+Pe,et+Ae,ke,mt,ke+Pe,mt+Ae,F.COLOR_BUFFER_BIT,F.NEAREST):Us?F.copyTexSubImage3D(Oe,Te,ke,mt,sn+ri,ze,et,Pe,Ae):F.copyTexSubImage2D(Oe,Te,ke,mt,ze,et,Pe,Ae);Me.bindFramebuffer(F.READ_FRAMEBUFFER,null),Me.bindFramebuffer(F.DRAW_FRAMEBUFFER,null)}else Us?w.isDataTexture||w.isData3DTexture?F.texSubImage3D(Oe,Te,ke,mt,sn,Pe,Ae,Ie,Ft,En,Ot.data):B.isCompressedArrayTexture?F.compressedTexSubImage3D(Oe,Te,ke,mt,sn,Pe,Ae,Ie,Ft,Ot.data):F.texSubImage3D(Oe,Te,ke,mt,sn,Pe,Ae,Ie,Ft,En,Ot):w.isDataTexture?F.texSubImage2D(F.TEXTURE_2D,Te,ke,mt,Pe,Ae,Ft,En,Ot.data):w.isCompressedTexture?F.compressedTexSubImage2D(F.TEXTURE_2D,Te,ke,mt,Ot.width,Ot.height,Ft,Ot.data):F.texSubImage2D(F.TEXTURE_2D,Te,ke,mt,Pe,Ae,Ft,En,Ot);Me.pixelStorei(F.UNPACK_ROW_LENGTH,mn),Me.pixelStorei(F.UNPACK_IMAGE_HEIGHT,St),Me.pixelStorei(F.UNPACK_SKIP_PIXELS,Ns),Me.pixelStorei(F.UNPACK_SKIP_ROWS,gn),Me.pixelStorei(F.UNPACK_SKIP_IMAGES,So),Te===0&&B.generateMipmaps===!0&&B.mipmapsAutoUpdate===!0&&F.generateMipmap(Oe),Me.unbindTexture()},this.initRenderTarget=function(w){Ve.get(w).__webglFramebuffer===void 0&&qe.setupRenderTarget(w)},this.initTexture=function(w){w.isCubeTexture?qe.setTextureCube(w,0):w.isData3DTexture?qe.setTexture3D(w,0):w.isDataArrayTexture||w.isCompressedArrayTexture?qe.setTexture2DArray(w,0):qe.setTexture2D(w,0),Me.unbindTexture()},this.resetState=function(){K=0,H=0,ce=null,Me.reset(),be.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return ki}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=_t._getDrawingBufferColorSpace(e),t.unpackColorSpace=_t._getUnpackColorSpace()}};var V1=`
attribute vec3 tint;
varying vec3 vTint;
uniform float size;
uniform float perspective;
uniform float least;
uniform float most;
void main() {
  vTint = tint;
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * place;
  gl_PointSize = clamp(perspective > 0.0 ? size * perspective / -place.z : size, least, most);
}`,G1=`
varying vec3 vTint;
void main() { gl_FragColor = vec4(vTint, 1.0); }`,uh=.14,q_=.5,H1=30,W1=120,ch=class{constructor(e){this.content=e;let{centroids:t,ids:i}=e;this.low=new V(1/0,1/0,1/0),this.high=new V(-1/0,-1/0,-1/0);let s=new V;for(let a=0;a<i.length;a+=1)s.fromArray(t,3*a),this.low.min(s),this.high.max(s);i.length||(this.low.set(-10,-10,-1),this.high.set(10,10,1)),this.middle=this.low.clone().add(this.high).multiplyScalar(.5),this.rows=X1(i.length);let r=new Float32Array(3*i.length);this.rows.forEach((a,l)=>{r[3*l]=t[3*a]-this.middle.x,r[3*l+1]=t[3*a+1]-this.middle.y,r[3*l+2]=t[3*a+2]-this.middle.z});let o=new Gn;o.setAttribute("position",new Sn(r,3)),this.tints=new Sn(new Uint8Array(3*i.length),3,!0),o.setAttribute("tint",this.tints),this.points=new $s(o,Y_(i.length<5e4?2.5:1.5,12)),this.colors=new Uint8Array(3*i.length),this.shapes=new $s(new Gn,Y_(1,40)),this.shapes.visible=!1;for(let a of[this.points,this.shapes])a.frustumCulled=!1;[this.paths,this.pathRobots]=q1(e,this.middle),this.group.add(this.points,this.shapes,this.paths),this.group.matrixAutoUpdate=!1,this.place(new Mt)}content;group=new Qi;points;paths;pathRobots;middle;low;high;rows;tints;shapes;shapeRows=new Uint32Array;shades=new Float32Array;colors;place(e){this.group.matrix.copy(e).multiply(new Mt().makeTranslation(this.middle)),this.group.matrixWorldNeedsUpdate=!0}get pose(){return this.group.matrix.clone().multiply(new Mt().makeTranslation(this.middle.clone().negate()))}rowOf(e){return Do(this.content.ids,e)}position(e){return new V().fromArray(this.content.centroids,3*e).applyMatrix4(this.pose)}colorPaths(e){let t=this.paths.geometry.getAttribute("color");this.pathRobots.forEach((i,s)=>t.setXYZ(s,...e(this.content.robots[i]??""))),t.needsUpdate=!0}setColors(e){this.colors=e,this.colorShapes();let t=this.tints.array;this.rows.forEach((i,s)=>{t[3*s]=e[3*i],t[3*s+1]=e[3*i+1],t[3*s+2]=e[3*i+2]}),this.tints.needsUpdate=!0}drawShapes(e){let t=e.reduce((r,o)=>r+o.points.length/3,0);if(this.shapes.geometry.dispose(),this.shapes.geometry=new Gn,this.shapes.visible=t>0,this.shapeRows=new Uint32Array(t),this.shades=new Float32Array(t),!t)return;let i=new Float32Array(3*t),s=0;for(let{row:r,points:o}of e){let a=[0,1,2].map(u=>this.content.centroids[3*r+u]-this.middle.getComponent(u)),[l,c]=[1/0,-1/0];for(let u=2;u<o.length;u+=3)[l,c]=[Math.min(l,o[u]),Math.max(c,o[u])];for(let u=0;u<o.length;u+=3,s+=1){this.shapeRows[s]=r,this.shades[s]=q_+(1-q_)*(o[u+2]-l)/Math.max(c-l,uh);for(let h=0;h<3;h+=1)i[3*s+h]=o[u+h]+a[h]}}this.shapes.geometry.setAttribute("position",new Sn(i,3)),this.shapes.geometry.setAttribute("tint",new Sn(new Uint8Array(3*t),3,!0)),this.colorShapes()}colorShapes(){if(!this.shapeRows.length)return;let e=this.shapes.geometry.getAttribute("tint"),t=e.array;this.shapeRows.forEach((i,s)=>{for(let r=0;r<3;r+=1)t[3*s+r]=this.shades[s]*this.colors[3*i+r]}),e.needsUpdate=!0}nearest(e,t,i){let s=new Mt().multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse).multiply(this.group.matrix).elements,r=t.clone().applyMatrix4(this.group.matrix.clone().invert()),o=this.points.geometry.getAttribute("position").array,a=[],l=0,c=1/0,u=()=>{a=a.sort((h,f)=>h[1]-f[1]).slice(0,i),a.length===i&&(c=a[i-1][1])};for(let h=0;h<this.rows.length;h+=1){let[f,d,g]=[o[3*h],o[3*h+1],o[3*h+2]],y=s[3]*f+s[7]*d+s[11]*g+s[15];if(y<=0||Math.abs(s[0]*f+s[4]*d+s[8]*g+s[12])>y||Math.abs(s[1]*f+s[5]*d+s[9]*g+s[13])>y)continue;l+=1;let p=Math.hypot(f-r.x,d-r.y);p>=c||(a.push([this.rows[h],p]),a.length>=4*i&&u())}return u(),{rows:a,inView:l}}limit(e){let t=Math.min(e,this.rows.length);return this.points.geometry.setDrawRange(0,t),t}pick(e,t,i,s,r,o){let a=new Mt().multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse).multiply(this.group.matrix).elements,l={row:-1,distance:o,depth:1/0};for(let[c,u]of[[this.points,this.rows],[this.shapes,this.shapeRows]]){if(!u.length)continue;let h=c.geometry.getAttribute("position").array;for(let f=0;f<u.length;f+=1){let[d,g,y]=[h[3*f],h[3*f+1],h[3*f+2]],p=a[3]*d+a[7]*g+a[11]*y+a[15];if(p<=0)continue;let m=((a[0]*d+a[4]*g+a[8]*y+a[12])/p+1)*.5*s,x=(1-(a[1]*d+a[5]*g+a[9]*y+a[13])/p)*.5*r,R=Math.hypot(m-t,x-i);R>o||(R<l.distance-1||R<l.distance+1&&p<l.depth)&&(l.row=u[f],l.distance=R,l.depth=p)}}return l}dispose(){for(let e of[this.points,this.shapes,this.paths])e.geometry.dispose(),e.material.dispose()}};function Y_(n,e){return new Vi({vertexShader:V1,fragmentShader:G1,uniforms:{size:{value:2},perspective:{value:0},least:{value:n},most:{value:e}}})}function X1(n){let e=new Uint32Array(n),t=2654435769;for(let i=0;i<n;i+=1){t^=t<<13,t^=t>>>17,t^=t<<5;let s=(t>>>0)%(i+1);e[i]=e[s],e[s]=i}return e}function q1(n,e){let t=new Int32Array(n.frameTimes.length).fill(-1);for(let l=0;l<n.ids.length;l+=1)t[n.frameIndex[l]]=n.robot[l];let i=new Map,s=[],r=[];t.forEach((l,c)=>{let u=i.get(l);if(i.set(l,c),l<0||u===void 0)return;let h=[0,1,2].map(d=>n.framePositions[3*c+d]-n.framePositions[3*u+d]);if(!(Math.hypot(...h)>H1||n.frameTimes[c]-n.frameTimes[u]>W1))for(let d of[u,c])s.push(n.framePositions[3*d]-e.x,n.framePositions[3*d+1]-e.y,n.framePositions[3*d+2]-e.z),r.push(l)});let o=new Gn;o.setAttribute("position",new Sn(new Float32Array(s),3)),o.setAttribute("color",new Sn(new Float32Array(s.length),3));let a=new wr(o,new Mr({vertexColors:!0}));return a.frustumCulled=!1,[a,r]}var ti=Ze(null),Qs=Ze(null),Xd=Ze(""),jt=Ze(null),bt=Ze(new Map),Mn=Ze(null),Es=Ze(new Set),er=Ze(null),yi=Ze("robot"),io=Ze([]),Pr=Ze(new Set),Rl=Ze(new Map),Pl=Ze(!0),Ir=Ze("maps"),Cs=Ze([]),ls=Ze([]),Cl=Ze(new Map),no=Ze(new Map),pa=Ze([]),Hi=Ze({on:!1,reason:""}),so=Ze(new Map),as=Ze(null),Il=Ze(!1),Ll=Ze(!1),oo=Ze(!1),ro=Ze(null),ao=Ze(0),Dl=Fi(()=>jt.value?.maps.find(n=>n.name===Mn.value)??null),j_=Fi(()=>{let n=[...bt.value.values()].flatMap(e=>e.robots).sort();return[...new Set([...n,...ls.value.map(e=>e.robot).sort()])].join(`
`)}),Q_=Fi(()=>new Map(j_.value.split(`
`).map((n,e)=>[n,e]))),fh=n=>No(Q_.value.get(n)??0),dh=Fi(()=>{let n=Mn.value?so.value.get(Mn.value)?.anchor:null;return n?.applies?n:null}),Wd=null,$_=0,hh=new AbortController,De=()=>Wd;function Hn(n,e,t=""){$_+=1;let i=$_,s=Cs.value.filter(r=>n==="error"||r.kind==="error");Cs.value=[...s.slice(-3),{id:i,kind:n,text:e,detail:t}],n==="done"&&setTimeout(()=>qd(i),8e3)}var Z_="No connection";function e0(){Hi.value.on||(Hi.value={on:!0,reason:""}),Cs.value.some(n=>n.text===Z_)&&(Cs.value=Cs.value.filter(n=>n.text!==Z_))}function qd(n){Cs.value=Cs.value.filter(e=>e.id!==n)}async function Vt(n){try{return await n()}catch(e){if(e instanceof yn&&e.status===401)Qs.value=lc()?"The service does not know this key.":"";else if(!(e instanceof yn&&e.status===0&&Cs.value.some(t=>t.text===e.title)))if(e instanceof yn){let t=e.retryAfter?` Try again in ${e.retryAfter} s.`:"";Hn("error",e.title,e.detail+t)}else Hn("error","The page failed",e instanceof Error?e.message:String(e));return}}function Lr(n){let e=ti.value;return!e?.may_write||e.robot!==null?!1:e.maps.some(t=>Y1(t,n))}var cs=Fi(()=>ti.value!==null&&ti.value.may_write&&ti.value.robot===null);function Y1(n,e){let t=n.replace(/[.+^${}()|\\]/g,"\\$&").replace(/\*/g,".*").replace(/\?/g,".").replace(/\[!/g,"[^");return new RegExp(`^${t}$`).test(e)}async function t0(n){Wd=n,Wd.onFrame=()=>ao.value+=1,Zi(()=>{j_.value,Bs(ii)}),await ph(lc())}async function ph(n){vf(n),hh.abort(),hh=new AbortController;try{let r=await gt.key();if(r.role==="none"){Qs.value=n?"The service does not know this key. Check it, or ask for a new one.":"";return}ti.value=r,Qs.value=null,Xd.value=(await gt.info()).version}catch(r){await Vt(()=>Promise.reject(r)),setTimeout(()=>{ph(n)},3e3);return}await ni();let e=new URLSearchParams(location.hash.slice(1)).get("map"),t=jt.value?.maps??[],i=t.find(r=>r.name===e)??(t.length===1?t[0]:void 0);i&&await mi(i.name);let{signal:s}=hh;zm(s,K1,(r,o)=>r?e0():Hi.value={on:r,reason:o}),$1(s)}function n0(){hh.abort(),vf("");for(let n of[...bt.value.keys()])ma(n);[jt.value,ti.value,ls.value,pa.value]=[null,null,[],[]],Qs.value=""}async function $1(n){for(;!n.aborted;)await new Promise(e=>setTimeout(e,3e3)),!(n.aborted||document.hidden)&&(await ni(!0),await i0())}async function ni(n=!1){try{jt.value=await gt.maps(),e0()}catch(e){if(n){Hi.value={on:!1,reason:e instanceof Error?e.message:""};return}await Vt(()=>Promise.reject(e));return}for(let[e,t]of bt.value){let i=jt.value.maps.find(s=>s.name===e);i?i.etag!==t.etag&&!Es.value.has(e)&&await mi(e,!1):ma(e)}}var K_=!0;async function i0(){if(K_){try{ls.value=await gt.robots()}catch(n){n instanceof yn&&n.status===404&&(K_=!1)}Z1()}}function Z1(){let n=new Map(Cl.value);for(let e of ls.value){if(!e.map||!e.position)continue;let t=n.get(e.robot),i=t?.map===e.map?t.places:[],s=i.at(-1);(!s||Math.hypot(...s.map((o,a)=>o-e.position[a]))>.2)&&n.set(e.robot,{map:e.map,places:[...i.slice(-999),e.position]})}Cl.value=n}var J_=new Map;function K1(n){let{data:e}=n,t=String(e.robot??""),i=`${String(e.state)} ${String(e.map)}`;if((n.kind!=="robot"||J_.get(t)!==i)&&(pa.value=[{...n,data:{...e,received:Date.now()/1e3}},...pa.value].slice(0,100)),n.kind==="robot"&&J_.set(t,i),["upload","merge","write"].includes(n.kind)&&ni(!0),n.kind==="fix"&&Array.isArray(e.inliers)){let s=String(e.robot??e.session??"");no.value=new Map([...no.value,[s,{map:String(e.map),position:e.position,inliers:e.inliers}]])}if(n.kind==="no-fix"){let s=String(e.robot??e.session??"");no.value=new Map([...no.value].filter(([r])=>r!==s))}["fix","no-fix","robot"].includes(n.kind)&&J1(),n.kind==="alarm"&&e.raised===!0&&Hn("error",`Alarm: ${String(e.alarm)}`,String(e.detail??""))}var Hd=!1;function J1(){Hd||(Hd=!0,setTimeout(()=>{Hd=!1,i0()},300))}async function mi(n,e=!0){Es.value=new Set([...Es.value,n]);let t=await Vt(()=>uc(n));if(Es.value=new Set([...Es.value].filter(a=>a!==n)),!t)return;let i=De().layers.get(n)?.pose,s=new ch(t),r=i??j1(s);De().add(s),s.place(r),bt.value=new Map([...bt.value,[n,t]]),(e||!Mn.value)&&(Mn.value=n),er.value?.map===n&&tr(null),ii(),e&&(De().fit(n),location.hash=new URLSearchParams({map:n}).toString());let o=await Vt(()=>gt.map(n));o&&(so.value=new Map([...so.value,[n,o]]))}function j1(n){let e=new V(-1/0,0,0);for(let t of De().layers.values()){if(t.content.name===n.content.name)continue;if(t.content.frame===n.content.frame)return t.pose;let i=t.low.clone().applyMatrix4(t.pose),s=t.high.clone().applyMatrix4(t.pose);e.set(Math.max(e.x,i.x+30,s.x+30),i.y,i.z)}return e.x===-1/0?new Mt:new Mt().makeTranslation(e.sub(n.low))}function ma(n){De().remove(n),bt.value=new Map([...bt.value].filter(([e])=>e!==n)),Mn.value===n&&(Mn.value=[...bt.value.keys()].at(-1)??null),er.value?.map===n&&tr(null),ii()}function ii(){let n=new Map,e=[...bt.value.values()],t=r=>{let o=new Map([...new Set(r)].sort().map((a,l)=>[a,l]));return a=>o.get(a)??0},i=r=>Q_.value.get(r)??0;if(as.value){for(let r of De().layers.values())r.setColors(new Uint8Array(3*r.content.ids.length).map((o,a)=>255*yf[a%3])),r.paths.visible=!1;io.value=[{color:ci(Gr),label:`added or replaced in version ${as.value.version}`},{color:ci(Hr),label:`removed in version ${as.value.version}`},{color:ci(yf),label:"not changed"}],De().redraw();return}let s={robot:i,origin:t(e.flatMap(r=>[r.name,...r.sources]))};bt.value.forEach((r,o)=>{let{colors:a,legend:l}=$m(r,yi.value,s[yi.value]??(u=>dc.indexOf(u)),Rl.value.get(o)??new Map,new Set(Pr.value)),c=De().layers.get(o);c?.setColors(a),c&&(c.paths.visible=Pl.value),c?.colorPaths(fh);for(let u of l)n.set(u.label,u)}),io.value=[...n.values()],De().redraw()}function tr(n){let e=er.value;if(er.value=n,De().overlay("alike",[]),!n){De().mark(null);return}let t=De().layers.get(n.map);if(!t)return;let i=t.position(n.row),{extents:s}=t.content,r=s?Math.max(.5,...[0,1,2].map(a=>s[3*n.row+a]/20)):1;De().mark(i,r);let o=e&&De().layers.get(e.map);if(oo.value&&e&&o){let a=o.position(e.row);ro.value={from:e,meters:i.distanceTo(a),vertical:i.z-a.z},De().overlay("measure",[{from:a,to:i,color:[1,1,1]}])}else ro.value=null,De().overlay("measure",[])}function s0(n){let t=[...De().layers.keys()].sort((l,c)=>+(c===Mn.value)-+(l===Mn.value)).filter(l=>De().layers.get(l).rowOf(n)!==void 0),i=er.value,s=i?t.findIndex(l=>l===i.map&&De().layers.get(l).rowOf(n)===i.row):-1,r=[...t.slice(s+1),...t.slice(0,s+1)],o=r[0]===void 0?void 0:De().layers.get(r[0]);if(!o)return[];let a=o.rowOf(n);return tr({map:o.content.name,row:a}),De().look(o.position(a),Math.min(De().reach(),30)),r}var Q1=Symbol.for("pv"),eT=0;function A(n,e,t,i,s,r){e||(e={});var o,a,l=e;if("ref"in l&&typeof n!="function")for(a in l={},e)a=="ref"?o=e[a]:l[a]=e[a];var c={type:n,props:l,key:t,ref:o,__k:null,__:null,__b:0,__e:null,__c:null,constructor:Q1,__v:--eT,__i:-1,__u:0};return(s||r)&&(c.__source=s,c.__self=r),Et.vnode&&Et.vnode(c),c}function ot(n){return A("button",{type:"button",class:n.kind??"","aria-disabled":n.disabled??!1,title:n.title??"","aria-label":n.label,"aria-pressed":n.pressed,onClick:()=>{n.disabled||n.onClick()},children:n.children})}function Rs(n){let e=Zn(null);Kt(()=>{let i=e.current,s=document.activeElement;return i.open||i.showModal(),()=>{i.close(),setTimeout(()=>{s instanceof HTMLElement&&s.isConnected&&s.focus()})}},[]);let t=i=>{i.preventDefault(),n.onClose?.()};return A("dialog",{ref:e,"aria-label":n.title,onCancel:t,children:[A("h2",{children:n.title}),n.children]})}function mh(n){let e=Zn(null),t=()=>{let i=e.current?.files?.[0];i&&n.onFile(i),e.current&&(e.current.value="")};return A(Ct,{children:[A(ot,{onClick:()=>e.current?.click(),children:n.label}),A("input",{ref:e,type:"file",class:"hidden","aria-label":n.label,tabIndex:-1,accept:n.accept??"",onChange:t})]})}var it=n=>n.toLocaleString("en-US");function Yd(n){return n<1e6?`${(n/1e3).toFixed(1)} kB`:n<1e9?`${(n/1e6).toFixed(1)} MB`:`${(n/1e9).toFixed(2)} GB`}function Nl(n){return n<90?`${Math.max(0,Math.round(n))} s ago`:n<5400?`${Math.round(n/60)} min ago`:n<129600?`${Math.round(n/3600)} h ago`:`${Math.round(n/86400)} days ago`}var r0=(n,e)=>n.toFixed(e).replace(/^-(0(\.0*)?)$/,"$1"),wn=n=>`${r0(n,Math.abs(n)<10?2:1)} m`,gh=n=>`${r0(n*180/Math.PI,1)}\xB0`,Dr=n=>`${(100*n).toFixed(n>.99&&n<1?1:0)}%`,_h=n=>n.map===null||n.pose_age===null||n.pose_age>n.age;function o0(n){return n.robot!==null?`robot ${n.robot}`:n.may_write?n.role:"read only"}function vh(n){let e=n.maps.includes("*")?"all maps":`the maps ${n.maps.join(", ")}`;return n.robot!==null?`You may look at ${e} and locate scans. The key belongs to robot ${n.robot}: it writes this robot's segments and no whole maps.`:n.may_write?`You may look at and change ${e}.`:`You may look at ${e}, locate scans, compare and download maps. You may not change, merge or upload maps. For this, sign in with a key from: placecell keys NAME --write`}function a0(){let[n,e]=Tt(""),[t,i]=Tt(!1),s=async r=>{r.preventDefault(),!t&&(i(!0),await ph(n.trim()),i(!1))};return A(Rs,{title:"Key",children:A("form",{onSubmit:r=>{s(r)},children:[A("p",{children:["This service needs a key. A key to read is enough to look; the operator of the service makes it with ",A("code",{children:"placecell keys"}),"."]}),A("label",{children:["Key ",A("input",{type:"password",autocomplete:"off",required:!0,value:n,onInput:r=>e(r.currentTarget.value)})]}),Qs.value&&A("p",{role:"alert",children:Qs.value}),A("div",{class:"row",children:A("button",{type:"submit",class:"main","aria-disabled":t,children:"Sign in"})})]})})}var l0={type:"change"},Zd={type:"start"},u0={type:"end"},xh=new Ys,c0=new ui,tT=Math.cos(70*Cd.DEG2RAD),Ln=new V,bi=2*Math.PI,Lt={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},$d=1e-6,yh=class extends ml{constructor(e,t=null){super(e,t),this.state=Lt.NONE,this.target=new V,this.cursor=new V,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:Gi.ROTATE,MIDDLE:Gi.DOLLY,RIGHT:Gi.PAN},this.touches={ONE:ns.ROTATE,TWO:ns.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle="auto",this._domElementKeyEvents=null,this._lastPosition=new V,this._lastQuaternion=new di,this._lastTargetPosition=new V,this._quat=new di().setFromUnitVectors(e.up,new V(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new oa,this._sphericalDelta=new oa,this._scale=1,this._panOffset=new V,this._rotateStart=new tt,this._rotateEnd=new tt,this._rotateDelta=new tt,this._panStart=new tt,this._panEnd=new tt,this._panDelta=new tt,this._dollyStart=new tt,this._dollyEnd=new tt,this._dollyDelta=new tt,this._dollyDirection=new V,this._mouse=new tt,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=iT.bind(this),this._onPointerDown=nT.bind(this),this._onPointerUp=sT.bind(this),this._onContextMenu=hT.bind(this),this._onMouseWheel=aT.bind(this),this._onKeyDown=lT.bind(this),this._onTouchStart=cT.bind(this),this._onTouchMove=uT.bind(this),this._onMouseDown=rT.bind(this),this._onMouseMove=oT.bind(this),this._interceptControlDown=fT.bind(this),this._interceptControlUp=dT.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=Lt.NONE,this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(l0),this.update(),this.state=Lt.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;Ln.copy(t).sub(this.target),Ln.applyQuaternion(this._quat),this._spherical.setFromVector3(Ln),this.autoRotate&&this.state===Lt.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let i=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(i)&&isFinite(s)&&(i<-Math.PI?i+=bi:i>Math.PI&&(i-=bi),s<-Math.PI?s+=bi:s>Math.PI&&(s-=bi),i<=s?this._spherical.theta=Math.max(i,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(i+s)/2?Math.max(i,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let o=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=o!=this._spherical.radius}if(Ln.setFromSpherical(this._spherical),Ln.applyQuaternion(this._quatInverse),t.copy(this.target).add(Ln),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let o=null;if(this.object.isPerspectiveCamera){let a=Ln.length();o=this._clampDistance(a*this._scale);let l=a-o;this.object.position.addScaledVector(this._dollyDirection,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){let a=new V(this._mouse.x,this._mouse.y,0);a.unproject(this.object);let l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;let c=new V(this._mouse.x,this._mouse.y,0);c.unproject(this.object),this.object.position.sub(c).add(a),this.object.updateMatrixWorld(),o=Ln.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;o!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(o).add(this.object.position):(xh.origin.copy(this.object.position),xh.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(xh.direction))<tT?this.object.lookAt(this.target):(c0.setFromNormalAndCoplanarPoint(this.object.up,this.target),xh.intersectPlane(c0,this.target))))}else if(this.object.isOrthographicCamera){let o=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),o!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>$d||8*(1-this._lastQuaternion.dot(this.object.quaternion))>$d||this._lastTargetPosition.distanceToSquared(this.target)>$d?(this.dispatchEvent(l0),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e!==null?bi/60*this.autoRotateSpeed*e:bi/60/60*this.autoRotateSpeed}_getZoomScale(e){let t=Math.abs(e*.01);return Math.pow(.95,this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){Ln.setFromMatrixColumn(t,0),Ln.multiplyScalar(-e),this._panOffset.add(Ln)}_panUp(e,t){this.screenSpacePanning===!0?Ln.setFromMatrixColumn(t,1):(Ln.setFromMatrixColumn(t,0),Ln.crossVectors(this.object.up,Ln)),Ln.multiplyScalar(e),this._panOffset.add(Ln)}_pan(e,t){let i=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;Ln.copy(s).sub(this.target);let r=Ln.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*r/i.clientHeight,this.object.matrix),this._panUp(2*t*r/i.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/i.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/i.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let i=this.domElement.getBoundingClientRect(),s=e-i.left,r=t-i.top,o=i.width,a=i.height;this._mouse.x=s/o*2-1,this._mouse.y=-(r/a)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(bi*this._rotateDelta.x/t.clientHeight),this._rotateUp(bi*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(bi*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-bi*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(bi*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-bi*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0;break}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),i=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._rotateStart.set(i,s)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),i=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panStart.set(i,s)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),i=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(i*i+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let i=this._getSecondPointerPosition(e),s=.5*(e.pageX+i.x),r=.5*(e.pageY+i.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(bi*this._rotateDelta.x/t.clientHeight),this._rotateUp(bi*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),i=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panEnd.set(i,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),i=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(i*i+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let o=(e.pageX+t.x)*.5,a=(e.pageY+t.y)*.5;this._updateZoomParameters(o,a)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new tt,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,i={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:i.deltaY*=16;break;case 2:i.deltaY*=100;break}return e.ctrlKey&&!this._controlActive&&(i.deltaY*=10),i}};function nT(n){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(n.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(n)&&(this._addPointer(n),n.pointerType==="touch"?this._onTouchStart(n):this._onMouseDown(n),this._cursorStyle==="grab"&&(this.domElement.style.cursor="grabbing")))}function iT(n){this.enabled!==!1&&(n.pointerType==="touch"?this._onTouchMove(n):this._onMouseMove(n))}function sT(n){switch(this._removePointer(n),this._pointers.length){case 0:this.domElement.releasePointerCapture(n.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(u0),this.state=Lt.NONE,this._cursorStyle==="grab"&&(this.domElement.style.cursor="grab");break;case 1:let e=this._pointers[0],t=this._pointerPositions[e];this._onTouchStart({pointerId:e,pageX:t.x,pageY:t.y});break}}function rT(n){let e;switch(n.button){case 0:e=this.mouseButtons.LEFT;break;case 1:e=this.mouseButtons.MIDDLE;break;case 2:e=this.mouseButtons.RIGHT;break;default:e=-1}switch(e){case Gi.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(n),this.state=Lt.DOLLY;break;case Gi.ROTATE:if(n.ctrlKey||n.metaKey||n.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(n),this.state=Lt.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(n),this.state=Lt.ROTATE}break;case Gi.PAN:if(n.ctrlKey||n.metaKey||n.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(n),this.state=Lt.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(n),this.state=Lt.PAN}break;default:this.state=Lt.NONE}this.state!==Lt.NONE&&this.dispatchEvent(Zd)}function oT(n){switch(this.state){case Lt.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(n);break;case Lt.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(n);break;case Lt.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(n);break}}function aT(n){this.enabled===!1||this.enableZoom===!1||this.state!==Lt.NONE||(n.preventDefault(),this.dispatchEvent(Zd),this._handleMouseWheel(this._customWheelEvent(n)),this.dispatchEvent(u0))}function lT(n){this.enabled!==!1&&this._handleKeyDown(n)}function cT(n){switch(this._trackPointer(n),this._pointers.length){case 1:switch(this.touches.ONE){case ns.ROTATE:if(this.enableRotate===!1){this.state=Lt.NONE;break}this._handleTouchStartRotate(n),this.state=Lt.TOUCH_ROTATE;break;case ns.PAN:if(this.enablePan===!1){this.state=Lt.NONE;break}this._handleTouchStartPan(n),this.state=Lt.TOUCH_PAN;break;default:this.state=Lt.NONE}break;case 2:switch(this.touches.TWO){case ns.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(n),this.state=Lt.TOUCH_DOLLY_PAN;break;case ns.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(n),this.state=Lt.TOUCH_DOLLY_ROTATE;break;default:this.state=Lt.NONE}break;default:this.state=Lt.NONE}this.state!==Lt.NONE&&this.dispatchEvent(Zd)}function uT(n){switch(this._trackPointer(n),this.state){case Lt.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(n),this.update();break;case Lt.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(n),this.update();break;case Lt.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(n),this.update();break;case Lt.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(n),this.update();break;default:this.state=Lt.NONE}}function hT(n){this.enabled!==!1&&n.preventDefault()}function fT(n){n.key==="Control"&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function dT(n){n.key==="Control"&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}var Kd=new ui,bh=new pl,ga=new tt,Jd=new V,Sh=class extends yh{constructor(e,t){super(e,t),this.screenSpacePanning=!1,this.mouseButtons={LEFT:Gi.PAN,MIDDLE:Gi.DOLLY,RIGHT:Gi.ROTATE},this.touches={ONE:ns.PAN,TWO:ns.DOLLY_ROTATE},this._panWorldStart=new V}_handleMouseDownPan(e){if(super._handleMouseDownPan(e),this._panOffset.set(0,0,0),this.screenSpacePanning===!0)return;Kd.setFromNormalAndCoplanarPoint(this.object.up,this.target);let i=this.domElement.getBoundingClientRect();ga.x=(e.clientX-i.left)/i.width*2-1,ga.y=-((e.clientY-i.top)/i.height)*2+1,bh.setFromCamera(ga,this.object),bh.ray.intersectPlane(Kd,this._panWorldStart)}_handleMouseMovePan(e){if(this.screenSpacePanning===!0){super._handleMouseMovePan(e);return}let i=this.domElement.getBoundingClientRect();ga.x=(e.clientX-i.left)/i.width*2-1,ga.y=-((e.clientY-i.top)/i.height)*2+1,bh.setFromCamera(ga,this.object),bh.ray.intersectPlane(Kd,Jd)&&(Jd.sub(this._panWorldStart),this._panOffset.copy(Jd).negate(),this.update())}};var pT=40,mT=988960;_t.enabled=!1;var Mh=class{constructor(e){this.canvas=e;this.renderer=new oh({canvas:e,antialias:!1,powerPreference:"high-performance",preserveDrawingBuffer:!0}),this.renderer.outputColorSpace=Zr,this.renderer.setPixelRatio(Math.min(window.devicePixelRatio,2)),this.scene.background=new yt(mT),this.perspective.up.set(0,0,1),this.perspective.position.set(-60,-60,60),this.above.up.set(0,1,0),this.above.position.set(0,0,1e3),this.controls={perspective:this.control(this.perspective),above:this.control(this.above)},this.controls.above.enableRotate=!1,this.controls.above.enabled=!1,this.marker=new zi(new hl(1,24,16),new ta({color:16777215,transparent:!0,opacity:.6,depthTest:!1})),this.marker.visible=!1,this.scene.add(this.marker),new ResizeObserver(()=>this.resize()).observe(e.parentElement),this.resize()}canvas;layers=new Map;drawn=0;total=0;frames=0;onFrame=()=>{};scene=new sl;overlays=new Map;renderer;perspective=new hi(55,1,.1,1e5);above=new sa(-1,1,1,-1,-1e5,1e5);controls;mode="perspective";budget=3e5;wasMoving=!1;moving=0;lastDraw=0;scheduled=!1;marker;control(e){let t=new Sh(e,this.canvas);return t.enableDamping=!1,t.maxPolarAngle=.49*Math.PI,t.addEventListener("change",()=>this.move()),t}get camera(){return this.mode==="above"?this.above:this.perspective}get isAbove(){return this.mode==="above"}get target(){return this.controls[this.mode].target}setAbove(e){if(e===this.isAbove)return;let t=this.target.clone(),i=this.reach();this.controls[this.mode].enabled=!1,this.mode=e?"above":"perspective";let s=this.controls[this.mode];s.enabled=!0,this.look(t,i)}reach(){return this.isAbove?this.above.top/this.above.zoom:this.perspective.position.distanceTo(this.target)*Math.tan(this.perspective.fov*Math.PI/360)}look(e,t){let i=this.controls[this.mode];if(this.isAbove)this.above.zoom=this.above.top/Math.max(t,.5),this.above.position.set(e.x,e.y,1e3),this.above.updateProjectionMatrix();else{let s=this.perspective.position.clone().sub(i.target);(s.lengthSq()<1e-6||s.z<.2*s.length())&&s.set(-1,-1,1.1),s.setLength(Math.max(t,.5)/Math.tan(this.perspective.fov*Math.PI/360)),this.perspective.position.copy(e).add(s)}i.target.copy(e),i.update(),this.move()}fit(e){let t=new ts;for(let[r,o]of this.layers)e!==void 0&&r!==e||t.union(new ts(o.low.clone(),o.high.clone()).applyMatrix4(o.pose));if(t.isEmpty())return;let i=t.getSize(new V),s=this.canvas.clientWidth/Math.max(this.canvas.clientHeight,1);this.look(t.getCenter(new V),.55*Math.max(i.y,i.x/s,10))}pan(e,t){let i=this.reach(),s=this.isAbove?new V(0,1,0):this.target.clone().sub(this.perspective.position).setZ(0).normalize(),r=new V(s.y,-s.x,0),o=s.multiplyScalar(t*i*.2).add(r.multiplyScalar(e*i*.2));this.camera.position.add(o),this.target.add(o),this.controls[this.mode].update(),this.move()}zoom(e){this.look(this.target.clone(),this.reach()/e)}turn(e){if(this.isAbove)return;let t=this.perspective.position.clone().sub(this.target).applyAxisAngle(new V(0,0,1),e);this.perspective.position.copy(this.target).add(t),this.controls.perspective.update(),this.move()}north(){if(this.isAbove)return 0;let e=this.target.clone().sub(this.perspective.position);return Math.atan2(-e.x,e.y)}add(e){this.remove(e.content.name),this.layers.set(e.content.name,e),this.scene.add(e.group),this.redraw()}remove(e){let t=this.layers.get(e);t&&(this.layers.delete(e),this.scene.remove(t.group),t.dispose(),this.redraw())}overlay(e,t,i=[]){let s=this.overlays.get(e);s&&(this.scene.remove(s),s.traverse(a=>{(a instanceof wr||a instanceof $s)&&(a.geometry.dispose(),a.material.dispose())}),this.overlays.delete(e));let r=new Qi,o=(t[0]?.from??i[0]?.points[0]??new V).clone();if(r.position.copy(o),t.length){let a=h0(t.flatMap(({from:l,to:c})=>[l,c]),t.flatMap(({color:l})=>[l,l]),o);r.add(new wr(a,new Mr({vertexColors:!0,depthTest:!1})))}for(let a of i.filter(l=>l.points.length)){let l=h0(a.points,a.colors,o);r.add(new $s(l,new na({vertexColors:!0,size:a.size,sizeAttenuation:!1,depthTest:!0})))}r.traverse(a=>a.frustumCulled=!1),r.children.length&&(this.overlays.set(e,r),this.scene.add(r)),this.redraw()}mark(e,t=1){this.marker.visible=e!==null,e&&(this.marker.position.copy(e),this.marker.scale.setScalar(t)),this.redraw()}pick(e,t){let{clientWidth:i,clientHeight:s}=this.canvas;this.camera.updateMatrixWorld();let r=null,o=14;for(let a of this.layers.values()){let l=a.pick(this.camera,e,t,i,s,o);l.row>=0&&l.distance<o&&(r={layer:a,row:l.row},o=l.distance)}return r}project(e){this.camera.updateMatrixWorld();let t=e.clone().project(this.camera);return Math.abs(t.x)>1||Math.abs(t.y)>1||Math.abs(t.z)>1?null:[(t.x+1)/2*this.canvas.clientWidth,(1-t.y)/2*this.canvas.clientHeight]}ground(e,t,i=this.target.z){let{clientWidth:s,clientHeight:r}=this.canvas,o=new V(2*e/s-1,1-2*t/r,0).unproject(this.camera);if(this.isAbove)return o.setZ(i);let a=o.clone().sub(this.perspective.position),l=(i-this.perspective.position.z)/a.z;return l>0?this.perspective.position.clone().add(a.multiplyScalar(l)):null}scale(){return 2*this.reach()/Math.max(this.canvas.clientHeight,1)}resize(){let{clientWidth:e,clientHeight:t}=this.canvas.parentElement;if(!e||!t)return;this.renderer.setSize(e,t,!1),this.perspective.aspect=e/t,this.perspective.updateProjectionMatrix();let i=100;this.above.zoom*=i/this.above.top,[this.above.left,this.above.right,this.above.top,this.above.bottom]=[-i*e/t,i*e/t,i,-i],this.above.updateProjectionMatrix(),this.redraw()}move(){this.moving=performance.now(),this.schedule()}redraw(){this.schedule()}schedule(){this.scheduled||(this.scheduled=!0,requestAnimationFrame(()=>{this.scheduled=!1,this.draw()}))}draw(){let e=performance.now(),t=e-this.moving<250||this.moving>this.lastDraw;this.total=[...this.layers.values()].reduce((a,l)=>a+l.content.ids.length,0);let i=t?Math.min(1,this.budget/Math.max(this.total,1)):1;this.drawn=0;let s=this.canvas.height/2,r=this.isAbove?s/this.reach():s/Math.tan(this.perspective.fov*Math.PI/360);for(let a of this.layers.values())this.drawn+=a.limit(Math.ceil(i*a.content.ids.length)),a.points.material.uniforms.size.value=this.isAbove?2.5:.6,a.points.material.uniforms.perspective.value=this.isAbove?0:s,a.shapes.material.uniforms.size.value=this.isAbove?uh*r:uh,a.shapes.material.uniforms.perspective.value=this.isAbove?0:r;this.camera.updateMatrixWorld(),this.renderer.render(this.scene,this.camera),this.frames+=1;let o=e-this.lastDraw;if(this.lastDraw=e,t&&this.wasMoving&&this.drawn>1e3){let a=this.drawn*pT/Math.max(o,1);this.budget=Math.max(2e4,.7*this.budget+.3*a)}this.wasMoving=t,this.onFrame(),t&&i<1&&setTimeout(()=>this.schedule(),260)}};function h0(n,e,t){let i=new Gn,s=new Float32Array(n.flatMap(r=>[r.x-t.x,r.y-t.y,r.z-t.z]));return i.setAttribute("position",new Sn(s,3)),i.setAttribute("color",new Sn(new Float32Array(e.flat()),3)),i}function lo(n){return new Mt().compose(new V(...n.translation),new di(...n.rotation),new V(1,1,1))}var Ps=n=>new V(...n);function wh(n,e,t){let[i,s,r]=[e[0]?.[0]??0,e[0]?.[1]??0,e[1]?.[1]??0],o=(i+r)/2,a=Math.sqrt(Math.max(0,((i-r)/2)**2+s*s)),[l,c]=[2*Math.sqrt(Math.max(o+a,0)),2*Math.sqrt(Math.max(o-a,0))],u=.5*Math.atan2(2*s,i-r),h=d=>{let[g,y]=[l*Math.cos(d),c*Math.sin(d)];return n.clone().add(new V(g*Math.cos(u)-y*Math.sin(u),g*Math.sin(u)+y*Math.cos(u),0))},f=32;return Array.from({length:f},(d,g)=>({from:h(2*Math.PI*g/f),to:h(2*Math.PI*(g+1)/f),color:t}))}function Th(n,e,t){let i=(o,a,l=0)=>new V(o,a,l).multiplyScalar(e).applyMatrix4(n),s=[[1,0],[-.6,.55],[-.25,0],[-.6,-.55],[1,0]];return[...s.slice(1).map(([o,a],l)=>({from:i(...s[l]),to:i(o,a),color:t})),{from:i(0,0),to:i(0,0,.8),color:t}]}var co=Ze(null),_a=Ze(""),Ul=Ze("");function f0(){co.value=null,Il.value=!1,De().overlay("scan",[])}async function Qd(n){_a.value=`Cutting ${n.name} into segments.`,f0();let e=await Vt(()=>gt.scan(n));e&&(co.value={file:n,scan:e,answers:null},p0(co.value,null),e.segments.length&&jt.value?.maps.length&&await jd(co.value)),_a.value=""}async function jd(n){_a.value="Searching the maps.";let e=await Vt(()=>gt.localize({segments:n.scan.segments.map(({points:i},s)=>({points:i,sensor:n.scan.sensors[s]??[0,0,0]})),...Ul.value?{maps:[Ul.value]}:{}}));if(_a.value="",!e)return;co.value={...n,answers:e.localizations};let t=e.localizations[0];t?.localized&&await d0(t)}async function d0(n){bt.value.has(n.map)||await mi(n.map,!1),Mn.value=n.map;let e=co.value;p0(e,n);let t=De().layers.get(n.map);if(!t||!n.pose)return;let i=Ps(n.pose.translation).applyMatrix4(t.pose);De().look(i,45),Rl.value=new Map([[n.map,new Map(n.inliers.map(s=>[s.id,1-Math.min(s.residual,1)]))]]),ii()}function p0(n,e){let t=e?De().layers.get(e.map):void 0,i=e?.pose&&t?t.pose.multiply(lo(e.pose)):lo({translation:gT(),rotation:[0,0,0,1]}),{points:s,labels:r}=n.scan.cloud,o=s.map(c=>Ps(c).applyMatrix4(i)),a=r.map(c=>c>=0?No(c):Kn),l=[...Th(i,2.5,Jn)];if(t&&e){for(let{query:c,id:u}of e.inliers){let h=t.rowOf(u),f=n.scan.segments[c]?.centroid;if(h===void 0||!f)continue;let d=Ps(f).applyMatrix4(i),g=d.clone().add(new V(0,0,8));l.push({from:d,to:g,color:Jn},{from:g,to:t.position(h),color:Jn})}e.covariance&&l.push(...wh(new V().applyMatrix4(i),e.covariance,Jn))}Il.value=!0,De().overlay("scan",l,[{points:o,colors:a,size:2}]),e||De().look(new V().applyMatrix4(i),45)}function gT(){let n=0;for(let e of De().layers.values())n=Math.min(n,e.low.clone().applyMatrix4(e.pose).x-60);return[n,0,0]}var _T={"too-few-segments":"The scan shows too few segments.",ambiguous:"Two places fit nearly as well.",inconsistent:"No place fits well enough."};function vT(n,e){let[t]=n;if(t?.rival)return`The maps ${t.map} and ${t.rival.map} both have a place like this one. If they show the same area, search one of them, or merge them.`;let i=t?.meters_to_drive,s=i?` Or take a scan about ${i.toFixed(0)} m farther on, where there are more segments.`:" Or take another scan some meters farther on.";return`Check that ${e.length===1?"the map covers":"one of the maps covers"} this place, that z points up, and that lengths are meters.${s}`}function m0(){let n=co.value,[e,t]=Tt(""),i=(jt.value?.maps??[]).some(s=>s.name===e);return A(Ct,{children:[A("p",{children:"Drop one LiDAR scan on this page to see its segments and where it was taken. PCD, PLY, LAS, LAZ, KITTI .bin, NumPy and CSV files work; z must point up."}),A("div",{class:"row",children:[A("label",{class:"grow",children:["Search in"," ",A("select",{value:Ul.value,onChange:s=>{Ul.value=s.currentTarget.value,n?.scan.segments.length&&jd(n)},children:[A("option",{value:"",children:"all maps"}),(jt.value?.maps??[]).map(s=>A("option",{value:s.name,children:s.name},s.name))]})]}),A(mh,{label:"Choose a scan",onFile:s=>{Qd(s)}})]}),_a.value&&A("p",{role:"status",children:_a.value}),n&&A("section",{"aria-label":"Result","aria-live":"polite",children:[A("h2",{children:n.file.name}),A("p",{children:[n.scan.format,": ",it(n.scan.points)," points, ",it(n.scan.segments.length)," segments."]}),n.scan.problems.map(s=>A("p",{class:"warning",children:[s.what," ",s.cure]},s.what)),!n.scan.segments.length&&A("p",{children:"No segment was found. A segment is an object of 100 or more points, such as a car or a trunk. Check that z points up and that lengths are meters."}),(n.answers?.length===0||jt.value?.maps.length===0)&&A("p",{children:["There is no map to search. ",cs.value&&"Make a new map of the scan: the service then knows this place."]}),n.answers&&n.answers.length>0&&!n.answers.some(s=>s.localized)&&A("p",{class:"warning",children:[A("b",{children:"The scan was not located."})," ",vT(n.answers,(jt.value?.maps??[]).map(s=>s.name))]}),n.answers?.[0]?.rival&&!n.answers[0].localized&&A("div",{class:"row",children:[n.answers[0].map,n.answers[0].rival.map].map(s=>A(ot,{onClick:()=>{Ul.value=s,jd(n)},children:["Search only ",s]},s))}),(n.answers??[]).slice(0,5).map(s=>A(xT,{answer:s,file:n.file},s.map)),cs.value&&n.scan.segments.length>0&&A("form",{class:"row",onSubmit:s=>{s.preventDefault(),i||g0(n.file,e,null)},children:[A("label",{class:"grow",children:["Make a new map of the scan ",A("input",{placeholder:"Name of the new map",required:!0,pattern:"[A-Za-z0-9][A-Za-z0-9._\\-]{0,63}",value:e,onInput:s=>t(s.currentTarget.value)})]}),A("button",{type:"submit","aria-disabled":i,children:"Make"}),i&&A("span",{role:"alert",children:["There is a map ",e," already. A scan comes into a map at its pose there: search in ",e,"."]})]}),A(ot,{onClick:f0,children:"Clear"})]})]})}async function g0(n,e,t){let i=jt.value?.maps.find(o=>o.name===e)?.segments??0,s=await Vt(()=>gt.addScan(e,"page",n,t));if(!s)return;let r=s.repeats?`; ${it(s.repeats)} were there already`:"";Hn("done",`${it(s.segments-i)} segments of ${n.name} added to ${e}${r}`,t?"To undo this, restore the version before under Versions.":""),await ni(),await mi(e,t===null)}function xT(n){let{answer:e,file:t}=n,{pose:i}=e;return A("div",{class:e.localized?"answer good":"answer",children:[A("b",{children:e.localized?`In ${e.map}`:`Not localized in ${e.map}`}),i&&e.localized?A(Ct,{children:[A("p",{children:["x ",wn(i.translation[0]),", y ",wn(i.translation[1]),", z ",wn(i.translation[2]),", heading ",gh(i.yaw)]}),A("p",{children:[Dr(e.probability)," sure; ",e.inliers.length," segments agree."]}),A("div",{class:"row",children:[A(ot,{onClick:()=>{d0(e)},children:"Show"}),Lr(e.map)&&A(ot,{onClick:()=>{g0(t,e.map,i)},children:["Add to ",e.map]})]})]}):A("p",{children:[_T[e.reason??""]??""," ",e.detail]})]})}var ep=Ze(null);function v0(n){let{map:e}=n,t=(jt.value?.maps??[]).filter(C=>C.name!==e.name),[i,s]=Tt(t[0]?.name??""),[r,o]=Tt(""),[a,l]=Tt(null),[c,u]=Tt(0),[h,f]=Tt(e.name),[d,g]=Tt(null),y=Zn(null);Kt(()=>()=>{y.current?.(),De().overlay("pairs",[])},[]);let p=async()=>{o("Aligning. This takes some seconds."),l(null),g(null);let C=await Vt(async()=>{for(let E of[e.name,i])bt.value.has(E)||await mi(E,!1);return gt.align(e.name,i)});o(""),C&&(l(C),y.current=C.pose?()=>y0(C,C.pose):null,m(C,0))},m=(C,E)=>{u(E);let v=_0(C)[E];v&&yT(C,v.pose)},x=async C=>{o(C?"Trying the merge. Nothing is written.":"Merging.");let E=jt.value?.maps.find(N=>N.name===h)??null,v=[e.name,i].filter(N=>N!==h),T=await Vt(()=>gt.merge(h,v,C,E?.etag??null));if(o(""),!T)return;if(C){g(T);return}g(null),ep.value=T;let z=T.parts.reduce((N,D)=>N+(D.merged?D.added:0),0);Hn("done",`${v.join(" and ")} merged into ${h}`,`${it(z)} segments added. Undo is in the list of maps.`),y.current=null,l(null),De().overlay("pairs",[]);for(let N of v)bt.value.has(N)&&ma(N);await ni(),await mi(h)};if(!t.length)return A("p",{children:"There is no other map to align with."});let R=a?_0(a):[],S=(jt.value?.maps??[]).some(C=>C.name===h);return A(Ct,{children:[A("div",{class:"row",children:[A("label",{class:"grow",children:["Other map"," ",A("select",{value:i,onChange:C=>{s(C.currentTarget.value),l(null),g(null)},children:t.map(C=>A("option",{value:C.name,children:C.name},C.name))})]}),A(ot,{kind:"main",disabled:r!=="",onClick:()=>{p()},children:"Align"})]}),r&&A("p",{role:"status",children:r}),a&&A("div",{role:"status",children:[A("p",{children:[a.aligned?`${i} fits: ${a.pairs} pairs of segments agree.`:`${i} is not aligned. ${a.detail}`,a.overlap&&` It covers ${Dr(a.overlap.of_map)} of ${e.name}.`]}),R.map((C,E)=>A(ot,{pressed:c===E,onClick:()=>m(a,E),children:[C.label,": ",C.note]},C.label)),a.aligned&&c>0&&A("p",{class:"warning",children:"The picture shows the second way. A merge uses the best one."})]}),a?.aligned&&cs.value&&A(Ct,{children:[A("div",{class:"row",children:[A("label",{class:"grow",children:["Merge into map ",A("input",{value:h,pattern:"[A-Za-z0-9][A-Za-z0-9._\\-]{0,63}",onInput:C=>{f(C.currentTarget.value),g(null)}})]}),A(ot,{disabled:r!==""||!h||!Lr(h),onClick:()=>{x(!0)},children:"Try the merge"})]}),A("p",{class:"facts",children:[S?`The map ${h} gets a new version.`:`A new map ${h} is made.`," ",e.name!==h&&`${e.name} stays as it is. `,i," stays as it is."]})]}),d&&A(Rs,{title:`Merge into ${d.map}?`,onClose:()=>g(null),children:[A("ul",{children:d.parts.map(C=>A("li",{children:C.merged?`${C.map}: ${it(C.added)} segments added, ${it(C.repeats)} were there already`:`${C.map} is left out: it does not fit`},C.map))}),A("p",{children:["The map will have ",it(d.segments)," segments. You can undo the merge."]}),A("div",{class:"row",children:[A(ot,{kind:"main",disabled:d.parts.every(C=>!C.merged),onClick:()=>{x(!1)},children:"Merge"}),A(ot,{onClick:()=>g(null),children:"Cancel"})]})]})]})}function x0(){let n=ep.value;if(!n)return null;let e=async()=>{if(ep.value=null,!!await Vt(async()=>(n.previous===null?await gt.deleteMap(n.map,n.etag):await gt.restore(n.map,n.previous,n.etag),!0))){Hn("done",`The merge into ${n.map} is undone`,n.previous===null?`The map ${n.map} is deleted.`:`${n.map} is as it was in version ${n.previous}.`),await ni();for(let{map:i}of n.parts)!bt.value.has(i)&&jt.value?.maps.some(s=>s.name===i)&&await mi(i,!1);De().fit()}};return A("div",{class:"row answer good",role:"status",children:[A("span",{class:"grow",children:[n.map," has ",it(n.segments)," segments after the merge."]}),A(ot,{kind:"danger",onClick:()=>{e()},children:"Undo the merge"})]})}function _0(n){let e=(i,s)=>`${s} pairs, ${wn(Math.hypot(...i.translation))} away, turned by ${gh(i.yaw)}`;return[...n.pose?[{label:"Best",pose:n.pose,note:e(n.pose,n.pairs)}]:[],...n.others.map((i,s)=>({label:n.pose?"Second":`Way ${s+1}`,pose:i.pose,note:e(i.pose,i.pairs)}))]}function y0(n,e){let[t,i]=[De().layers.get(n.map),De().layers.get(n.other)];t&&i&&i.place(t.pose.multiply(lo(e))),De().redraw()}function yT(n,e){let[t,i]=[De().layers.get(n.map),De().layers.get(n.other)];if(!t||!i)return;y0(n,e);let s=n.pose===e,r=n.inliers.flatMap(o=>{let[a,l]=[t.rowOf(o.id),i.rowOf(o.other_id)];if(a===void 0||l===void 0)return[];let c=t.position(a),u=c.clone().setZ(c.z+6);return[{from:c,to:u,color:s?Jn:Kn},{from:u,to:i.position(l),color:s?Jn:Kn}]});De().overlay("pairs",r),De().fit()}var b0=300,bT=50,ST=250,MT=3e3,wT=5,TT=2,uo=Ze(!1),Ah=Ze(null),Eh=n=>so.value.get(n)?.shapes??!1,w0=Fi(()=>[...bt.value.keys()].some(Eh)),nr=new Map,tp=new AbortController,[np,S0]=["",""];function T0(){uo.value=!uo.value;let n=[...bt.value.values()].some(e=>e.classes&&Eh(e.name));!uo.value||!n||yi.value==="class"||(yi.value="class",Pr.value=new Set,ii())}function A0(){Zi(()=>{ao.value;let n=[...bt.value].filter(([t])=>Eh(t)),e=uo.value&&n.length>0;Bs(()=>AT(e))})}function AT(n){let e=De(),{matrixWorld:t,projectionMatrix:i}=e.camera,r=(n?E0():[]).map(({content:c,group:u})=>`${c.name} ${c.etag} ${u.matrix.elements.join()}`).join(`
`),o=n?[...t.elements,...i.elements].join():"";if(r===np&&o===S0)return;let a=r===np?ST:0;if([np,S0]=[r,o],tp.abort(),tp=new AbortController,!n){for(let c of e.layers.values())c.drawShapes([]);Ah.value=null,e.redraw();return}let{signal:l}=tp;setTimeout(()=>{ET(l)},a)}var E0=()=>[...De().layers.values()].filter(n=>Eh(n.content.name));async function ET(n){if(n.aborted)return;let e=De(),t=E0().map(o=>({layer:o,...o.nearest(e.camera,e.target,b0)})),i=t.reduce((o,a)=>o+a.inView,0),s=t.flatMap(({layer:o,rows:a})=>a.map(([l,c])=>({layer:o,row:l,away:c})));s.sort((o,a)=>o.away-a.away).splice(b0),M0(s,i);let r=s.filter(o=>!nr.has(va(o)));for(;r.length;){let{layer:o}=r[0],a=r.filter(l=>l.layer===o).slice(0,bT);if(!await CT(o,a,n))return;r=r.filter(l=>!a.includes(l)),M0(s,i)}for(let o of s){let a=nr.get(va(o));nr.delete(va(o)),nr.set(va(o),a)}for(let o of nr.keys()){if(nr.size<=MT)break;nr.delete(o)}}async function CT(n,e,t){let{name:i,ids:s,centroids:r}=n.content;for(let o=1;;o+=1)try{let a=await gt.shapes(i,e.map(({row:c})=>s[c]),t);if(t.aborted)return!1;let l=new Map(a.shapes.map(c=>[c.id,c.points]));for(let c of e){let u=l.get(s[c.row])??[],h=new Float32Array(3*u.length);u.forEach((f,d)=>{for(let g=0;g<3;g+=1)h[3*d+g]=f[g]-r[3*c.row+g]}),nr.set(va(c),h)}return!0}catch(a){if(t.aborted)return!1;if(!(a instanceof yn&&[0,429,503,504].includes(a.status))||o===wT)return uo.value=!1,await Vt(()=>Promise.reject(a)),!1;let c=a.retryAfter??TT;if(await new Promise(u=>setTimeout(u,1e3*c)),t.aborted)return!1}}function va({layer:{content:n},row:e}){let t=n.centroids.subarray(3*e,3*e+3).join();return`${n.name} ${n.modelId} ${n.ids[e]} ${t}`}function M0(n,e){let t=0;for(let i of De().layers.values()){let s=n.filter(r=>r.layer===i).flatMap(r=>{let o=nr.get(va(r));return o?[{row:r.row,points:o}]:[]});i.drawShapes(s),t+=s.length}Ah.value={inView:e,chosen:n.length,drawn:t},De().redraw()}var C0=.0033528106647474805;function R0(n,e,t){let i=n.yaw_deg*Math.PI/180,[s,r]=[e-n.position[0],t-n.position[1]],o=s*Math.cos(i)-r*Math.sin(i),a=s*Math.sin(i)+r*Math.cos(i),l=n.lat*Math.PI/180,c=C0*(2-C0),u=Math.sqrt(1-c*Math.sin(l)**2),h=6378137*(1-c)/u**3,f=6378137/u*Math.cos(l);return{lat:n.lat+a/(h+n.height)*(180/Math.PI),lon:n.lon+o/(f+n.height*Math.cos(l))*(180/Math.PI)}}function P0(){let n=Zn(null),[e,t]=Tt(""),[i,s]=Tt(null);Kt(()=>{try{t0(new Mh(n.current)),A0()}catch(u){t(`This browser draws no 3D pictures (WebGL): ${u instanceof Error?u.message:""}`)}},[]);let r=Zn([0,0]),o=u=>{let h=n.current.getBoundingClientRect();return[u.clientX-h.left,u.clientY-h.top]},a=u=>{let[h,f]=o(u);if(u.button!==0||Math.hypot(h-r.current[0],f-r.current[1])>4)return;let d=De().pick(h,f);tr(d?{map:d.layer.content.name,row:d.row}:null)},l=bt.value.size>0||Il.value,c=[...Es.value];return A("section",{class:"stage","aria-label":"Map view",children:[A("canvas",{ref:n,tabIndex:0,role:"img","aria-label":"Segments of the open maps. Arrow keys move, plus and minus zoom, Q and E turn, T shows from above, F shows all.",onPointerDown:u=>r.current=o(u),onPointerUp:a,onPointerMove:u=>s(o(u)),onPointerLeave:()=>s(null),onKeyDown:LT}),e&&A("p",{class:"failure",role:"alert",children:e}),A(UT,{}),A(IT,{}),A(DT,{}),l&&A(OT,{}),l&&A(FT,{pointer:i}),!l&&A("p",{class:"empty",role:"status",children:c.length?`Loading ${c.join(", ")}.`:RT[cs.value?1:0]})]})}var RT=["Choose a map in the list to see it here, or drop a scan on this page to find where it was taken.","Choose a map in the list to see it here. Drop a scan on this page to find where it was taken, or a map file to store it."],PT=60;function IT(){let n=Zn(null),e=De(),[t,i]=[ls.value,bt.value.size>1],s=[];if(e){for(let r of t){let o=r.map?e.layers.get(r.map):void 0;if(!o||!r.position)continue;let a=_h(r)?`${r.robot}, last pose`:r.robot;s.push({name:a,kind:"robot",place:Ps(r.position).applyMatrix4(o.pose)})}if(i)for(let r of e.layers.values()){let{low:o,high:a,content:l}=r;s.push({name:l.name,kind:"map",place:new V(.5*(o.x+a.x),a.y,o.z).applyMatrix4(r.pose)})}}return s.splice(PT),s.length&&ao.value,Kt(()=>{if(!s.length)return;let r=n.current.children,o=[];s.forEach(({place:a},l)=>{let c=e.project(a),u=r[l];if(u){for(u.hidden=c===null;c&&o.some(([h,f])=>Math.abs(c[0]-h)<90&&Math.abs(c[1]-f)<17);)c[1]+=17;c&&o.push(c),c&&(u.style.transform=`translate(${c[0].toFixed(0)}px, ${c[1].toFixed(0)}px)`)}})}),s.length?A("div",{class:"labels","aria-hidden":"true",ref:n,children:s.map(({name:r,kind:o})=>A("span",{class:o,children:A("b",{children:r})},`${o} ${r}`))}):null}function LT(n){let e=De(),i={ArrowUp:()=>e.pan(0,1),ArrowDown:()=>e.pan(0,-1),ArrowLeft:()=>e.pan(-1,0),ArrowRight:()=>e.pan(1,0),"+":()=>e.zoom(1.25),"=":()=>e.zoom(1.25),"-":()=>e.zoom(.8),q:()=>e.turn(.2),e:()=>e.turn(-.2),t:I0,f:()=>e.fit(),m:L0,Escape:()=>tr(null)}[n.key.length===1?n.key.toLowerCase():n.key];!i||n.ctrlKey||n.metaKey||n.altKey||(n.preventDefault(),i())}function I0(){Ll.value=!Ll.value,De().setAbove(Ll.value)}function L0(){oo.value=!oo.value,oo.value||(ro.value=null,De().overlay("measure",[]))}function DT(){let[n,e]=Tt(""),[t,i]=Tt(""),[s,r]=Tt(!1),o=a=>{if(a.preventDefault(),!n)return;let[l,...c]=s0(Number(n));bt.value.size?i(l?c.length?`Segment ${n} of ${l}. ${c.join(", ")} ${c.length>1?"have":"has"} this id too: press Find again.`:"":`${[...bt.value.keys()].join(" and ")} ${bt.value.size>1?"have":"has"} no segment ${n}.`):i("Open a map first; its segments can then be found by id.")};return A("div",{class:s?"tools wide":"tools",children:[A("button",{type:"button",class:"more","aria-expanded":s,onClick:()=>r(!s),children:"Tools"}),A("label",{children:["Color by"," ",A("select",{value:yi.value,onChange:a=>{yi.value=a.currentTarget.value,Pr.value=new Set,ii()},children:Object.entries(Sf).map(([a,l])=>A("option",{value:a,children:l},a))})]}),A(ot,{onClick:I0,pressed:Ll.value,title:"Key: T",children:"From above"}),A(ot,{onClick:()=>De().fit(),title:"Key: F",children:"Show all"}),A(ot,{onClick:L0,pressed:oo.value,title:"Click two segments. Key: M",children:"Measure"}),A(ot,{onClick:()=>{Pl.value=!Pl.value,ii()},pressed:Pl.value,children:"Paths"}),w0.value&&A(ot,{onClick:T0,pressed:uo.value,title:"Shapes that the service decodes from the codes of the segments",children:"Shapes"}),A("form",{onSubmit:o,children:[A("label",{children:[A("span",{class:"hidden",children:"Segment id"}),A("input",{inputMode:"numeric",pattern:"[0-9]*",placeholder:"Segment id",title:"Id of a segment: digits only. Click a segment to see its id.",value:n,onInput:a=>{e(a.currentTarget.value),i("")}})]}),A("button",{type:"submit",children:"Find"})]}),t&&A("span",{role:"alert",children:t}),A(NT,{}),oo.value&&A("span",{role:"status",children:ro.value?`${wn(ro.value.meters)} apart, ${wn(ro.value.vertical)} of it up`:"Choose two segments."})]})}function NT(){let n=Ah.value;if(!n)return null;let{inView:e,chosen:t,drawn:i}=n;return i<t?A("span",{role:"status",children:["Loading shapes: ",i," of ",t,"."]}):t<e?A("span",{role:"status",children:["Zoom in to see all shapes: ",t," of ",it(e)," are drawn."]}):A("span",{role:"status",children:[it(i)," ",i===1?"shape":"shapes"]})}function UT(){if(!io.value.length)return null;let n=!as.value&&(yi.value==="robot"||yi.value==="origin"||yi.value==="class"),e=t=>{let i=new Set(Pr.value);i.delete(t)||i.add(t),Pr.value=i,ii()};return A("ul",{class:"legend","aria-label":`Colors: ${Sf[yi.value]}`,children:[io.value.slice(0,14).map(({color:t,label:i})=>A("li",{children:[A(Ol,{color:t}),n?A("button",{type:"button",class:"plain","aria-pressed":!Pr.value.has(i),title:"Gray or colored",onClick:()=>e(i),children:i}):i]},i)),io.value.length>14&&A("li",{children:["and ",io.value.length-14," more"]})]})}function Ol(n){let e=Zn(null);return Kt(()=>{e.current.style.background=n.color},[n.color]),A("span",{class:"swatch",ref:e,"aria-hidden":"true"})}function OT(){let n=Zn(null),e=dh.value;return ao.value,Kt(()=>{let t=De();if(!t)return;let i=t.north()+(e?e.yaw_deg*Math.PI/180:0);n.current.style.transform=`rotate(${i}rad)`}),A("div",{class:"compass",title:e?"North":"The map's y axis. A map with a WGS84 anchor shows north.",children:A("div",{ref:n,children:[A("i",{"aria-hidden":"true",children:"\u25B2"}),A("b",{children:e?"N":"y"})]})})}function FT(n){let e=Zn(null),t=De();ao.value;let i=t?t.scale():1,s=10**Math.floor(Math.log10(Math.max(i*110,1e-6))),r=[5,2,1].map(u=>u*s).find(u=>u<=i*110)??s;Kt(()=>{e.current.style.width=`${Math.round(r/i)}px`});let o=t&&Mn.value?t.layers.get(Mn.value):void 0,a=t&&n.pointer?t.ground(...n.pointer):null,l=a&&o?a.applyMatrix4(o.pose.invert()):a,c=l&&dh.value?R0(dh.value,l.x,l.y):null;return A("div",{class:"scale",children:[A("div",{ref:e,class:"bar"}),A("span",{children:r>=1e3?`${r/1e3} km`:`${Number(r.toPrecision(1))} m`}),t&&t.total>0&&A("span",{class:"count",children:[t.drawn<t.total?`${it(t.drawn)} of `:"",it(t.total)," segments"]}),l&&A("span",{class:"place",children:["x ",l.x.toFixed(1),", y ",l.y.toFixed(1)]}),c&&A("span",{class:"place",children:[c.lat.toFixed(6),", ",c.lon.toFixed(6)]})]})}var ip=Ze(null),BT={"not-explained-by-drift":"the odometry cannot have drifted so far",unsupported:"no other loops agree",inconsistent:"contradicts other loops",outlier:"does not fit the optimized poses"},kT=[[Kn,"capture now"],[Jn,"where it would move"],[Gr,"accepted loop"],[Hr,"rejected loop"]];function U0(n){let{map:e}=n,[t,i]=Tt(""),[s,r]=Tt(null),[o,a]=Tt(!1);Kt(()=>()=>N0(),[e.etag]),Kt(()=>{r(null),a(!1)},[e.etag]);let l=async()=>{i("Looking for loops. This takes some seconds for each kilometer. Nothing is written."),r(null),N0();let u=await Vt(()=>gt.optimize(e.name,e.etag,!0));i(""),u&&(r(u),VT(e.name,u))},c=async()=>{a(!1),i("Moving the captures.");let u=await Vt(()=>gt.optimize(e.name,e.etag,!1));if(i(""),!!u){if(u.sequence===null){Hn("done",`${e.name} stays as it is`,"No capture has to move.");return}ip.value=u,Hn("done",`The drift of ${e.name} is removed`,`${it(u.changed)} segments moved.`),await ni()}};return A(Ct,{children:[A("p",{children:"A place that a robot has visited twice closes a loop. Loops show how far the odometry has drifted, and the map is bent so that they fit."}),A("div",{class:"row",children:A(ot,{kind:"main",disabled:t!=="",onClick:()=>{l()},children:"Look for loops"})}),t&&A("p",{role:"status",children:t}),s&&A("div",{role:"status",children:[A("p",{children:zT(s)}),s.parts.length>1&&A(Ct,{children:[A("p",{children:"Nothing connects these parts of the map. Each keeps its place relative to the others:"}),A("ul",{children:s.parts.slice(0,8).map((u,h)=>A("li",{children:[u.robots.join(", "),": ",it(u.captures)," captures, moved at most ",wn(u.moved_m)]},h))})]}),D0(s).length>0&&A(Ct,{children:[A("p",{children:"Rejected loops:"}),A("ul",{children:D0(s).map(([u,h])=>A("li",{children:[it(h),": ",BT[u]??u]},u))})]}),A("ul",{"aria-label":"Colors of the preview",children:kT.map(([u,h])=>A("li",{children:[A(Ol,{color:ci(u)}),h]},h))}),s.moved_max_m>0?A(ot,{disabled:t!=="",onClick:()=>a(!0),children:"Remove the drift"}):A("p",{children:"There is nothing to move."})]}),o&&s&&A(Rs,{title:`Remove the drift of ${e.name}?`,onClose:()=>a(!1),children:[A("p",{children:[it(s.captures)," captures move by ",wn(s.moved_median_m)," in the median and ",wn(s.moved_max_m)," at most. Their segments move with them."]}),A("p",{children:"The result is a new version. You can undo it."}),A("div",{class:"row",children:[A(ot,{kind:"main",onClick:()=>{c()},children:"Remove the drift"}),A(ot,{onClick:()=>a(!1),children:"Cancel"})]})]})]})}function O0(){let n=ip.value,e=jt.value?.maps.find(i=>i.name===n?.map);if(!n||e?.etag!==n.etag)return null;let t=async()=>{await Vt(()=>gt.restore(n.map,n.previous,n.etag))&&(ip.value=null,Hn("done",`The optimization of ${n.map} is undone`,`${n.map} is as it was in version ${n.previous}.`),await ni())};return A("div",{class:"row answer good",role:"status",children:[A("span",{class:"grow",children:["The captures of ",n.map," have moved by ",wn(n.moved_max_m)," at most."]}),A(ot,{kind:"danger",onClick:()=>{t()},children:"Undo the optimization"})]})}function zT(n){if(!n.loops_found)return"No place was visited twice, or the service does not recognize one. Nothing moves.";let e=n.loops_accepted?` They are ${wn(n.residual_before_m)} off now and would be ${wn(n.residual_after_m)} off. The captures would move by ${wn(n.moved_median_m)} in the median and ${wn(n.moved_max_m)} at most.`:"";return`${it(n.loops_accepted)} of ${it(n.loops_found)} loops are accepted.${e}`}function D0(n){let e=new Map;for(let{verdict:t}of n.loops)t!=="accepted"&&e.set(t,(e.get(t)??0)+1);return[...e]}function VT(n,e){let t=bt.value.has(n)?De().layers.get(n):void 0;if(!t)return;let i=l=>new V(...l).applyMatrix4(t.pose),s=e.frames.map(({before:l,after:c})=>({from:i(l),to:i(c),color:Jn})),r=e.loops.map(({positions:[l,c],verdict:u})=>({from:i(l),to:i(c),color:u==="accepted"?Gr:Hr})),o=e.frames.map(l=>i(l.before)),a=e.frames.map(l=>i(l.after));De().overlay("optimization",[...s,...r],[{points:o,colors:o.map(()=>Kn),size:4},{points:a,colors:a.map(()=>Jn),size:4}])}function N0(){De().overlay("optimization",[])}var F0={put:"stored whole",edit:"edited",merge:"merged",restore:"restored an earlier version",age:"pruned",optimize:"moved by an optimization"};function z0(n){let{map:e}=n,[t,i]=Tt(null),[s,r]=Tt(!1),[o,a]=Tt(null),l=as.value?.map===e.name?as.value.version:null,[c,u]=Tt(null),h=s&&Hi.value.on;if(Kt(()=>{t&&!s||Vt(()=>gt.versions(e.name)).then(p=>{r(!p),p&&i(p)})},[h]),Kt(()=>()=>k0(),[]),!t)return A("p",{role:"status",children:s?"The versions could not be read. The page tries again when the service answers.":"Loading the versions."});let f=async p=>{if(k0(),l===p.sequence)return;let m=await GT(e.name,p.sequence);m&&(a(m),HT(e.name,m),as.value={map:e.name,version:p.sequence},ii())},d=async p=>{let m=await gt.restore(e.name,p.sequence,e.etag,!0).catch(()=>null);u({version:p,effect:m})},g=async()=>{let{version:p}=c;u(null),await Vt(()=>gt.restore(e.name,p.sequence,e.etag))&&(Hn("done",`Version ${p.sequence} of ${e.name} is restored`,`To undo this, restore version ${e.sequence}.`),await ni())},y=c?t.filter(p=>p.sequence>c.version.sequence):[];return A(Ct,{children:[A("ol",{class:"versions",children:t.map((p,m)=>A("li",{children:[A("b",{children:["Version ",p.sequence]})," ",m===0&&A("em",{children:"now"}),A("span",{class:"facts",children:[new Date(1e3*p.time).toISOString().slice(0,16).replace("T"," "),", ",F0[p.operation]??p.operation," by ",p.author,":"," ",B0(p)]}),l===p.sequence&&o&&A("span",{class:"facts",role:"status",children:["Shown in the picture: ",it(o.added.length)," segments added or replaced in version ",p.sequence,", ",it(o.gone.length)," removed."]}),A("div",{class:"row",children:[A(ot,{pressed:l===p.sequence,onClick:()=>{f(p)},children:"Show changes"}),m>0&&Lr(e.name)&&A(ot,{onClick:()=>{d(p)},children:"Restore"})]})]},p.sequence))}),c&&A(Rs,{title:`Restore version ${c.version.sequence}?`,onClose:()=>u(null),children:[A("p",{children:["The map ",e.name," will be as it was in version ",c.version.sequence,". This undoes ",y.length===1?"one version":`${y.length} versions`,":"]}),A("ul",{children:y.slice(0,6).map(p=>A("li",{children:["version ",p.sequence,", ",F0[p.operation]??p.operation," by ",p.author,": ",B0(p)]},p.sequence))}),c.effect&&A("p",{children:[it(c.effect.changed)," segments will be added or replaced, ",it(c.effect.removed)," removed."]}),A("p",{children:"Nothing is lost: the restore is a new version, and can be undone too."}),A("div",{class:"row",children:[A(ot,{kind:"main",onClick:()=>{g()},children:"Restore"}),A(ot,{onClick:()=>u(null),children:"Cancel"})]})]})]})}function B0(n){return n.operation==="restore"?`all ${it(n.changed)} segments stored again`:`${it(n.changed)} added or replaced, ${it(n.removed)} removed`}async function GT(n,e){return Vt(async()=>{let{changed:t,removed:i,whole:s}=Hm(n,await gt.versionChanges(n,e)),r=(u,h)=>new V().fromArray(u.centroids,3*h),o=Array.from(t.ids,(u,h)=>h),a=e>1&&(s||i.length)?await uc(n,e-1).catch(u=>{if(s)return null;throw u}):null;if(!a)return{added:o.map(u=>r(t,u)),gone:[]};if(!s){let u=[...i].flatMap(h=>{let f=Do(a.ids,h);return f===void 0?[]:[r(a,f)]});return{added:o.map(h=>r(t,h)),gone:u}}let l=u=>{let h=Do(a.ids,t.ids[u]);return h!==void 0&&a.robots[a.robot[h]]===t.robots[t.robot[u]]&&r(a,h).distanceTo(r(t,u))<.005},c=Array.from(a.ids,(u,h)=>Do(t.ids,u)===void 0?[r(a,h)]:[]).flat();return{added:o.filter(u=>!l(u)).map(u=>r(t,u)),gone:c}})}function HT(n,{added:e,gone:t}){let i=De().layers.get(n);if(!i)return;let s=r=>r.map(o=>o.clone().applyMatrix4(i.pose));De().overlay("version",[],[{points:s(e),colors:e.map(()=>Gr),size:5},{points:s(t),colors:t.map(()=>Hr),size:5}])}function k0(){De().overlay("version",[]),as.value&&(as.value=null,ii())}var ho=Ze(null);async function sp(n){if(await Xm(n)){cs.value?ho.value=n:Hn("error","This key may not store maps","Sign in with a key that may write maps, then drop the file again.");return}Ir.value="locate",await Qd(n)}function V0(){let[n,e]=Tt(""),t=jt.value?.maps??[],i=t.filter(o=>`${o.name} ${Object.keys(o.robots).join(" ")} ${o.tags.join(" ")}`.toLowerCase().includes(n.toLowerCase())),s=i.slice(0,200),r=Dl.value&&G0(Dl.value)&&!s.includes(Dl.value)?Dl.value:null;return A(Ct,{children:[A("div",{class:"row",children:[A("label",{class:"grow",children:[A("span",{class:"hidden",children:"Search maps and robots"}),A("input",{type:"search",placeholder:"Search maps and robots",value:n,onInput:o=>e(o.currentTarget.value)})]}),cs.value&&A(mh,{label:"Add a file",onFile:o=>{sp(o)}})]}),!jt.value&&A("p",{role:"status",children:"Loading the list of maps."}),jt.value&&t.length>0&&!i.length&&A("p",{children:["No map and no robot has ",n," in its name."]}),jt.value&&!t.length&&A("p",{children:["There are no maps yet. A robot makes one with ",A("code",{children:"placecell robot"}),"; ",cs.value?"or add a map file or a scan here.":"or sign in with a key that may write, and add a map file."]}),A(x0,{}),A(O0,{}),A("ul",{class:"maps",children:[s.map(o=>A(WT,{map:o},o.name)),(jt.value?.damaged??[]).map(o=>A("li",{class:"damaged",children:[A("b",{children:o}),A("span",{children:"damaged: it cannot be read. Restore it from a backup."})]},o))]}),i.length>200&&A("p",{children:[it(i.length-200)," more maps. Search for a name."]}),r&&A(H0,{map:r})]})}var G0=n=>Mn.value===n.name&&bt.value.has(n.name);function WT(n){let{map:e}=n,t=bt.value.has(e.name),i=Object.keys(e.robots),s=e.time_span?.[1];return A("li",{class:Mn.value===e.name?"current":"",children:[A("label",{class:"check",children:A("input",{type:"checkbox",checked:t||Es.value.has(e.name),"aria-label":`Show map ${e.name}`,onChange:()=>t?ma(e.name):void mi(e.name)})}),A("button",{type:"button",class:"plain name",onClick:()=>{t?(Mn.value=e.name,De().fit(e.name)):mi(e.name)},children:e.name}),A("span",{class:"facts",children:[it(e.segments)," segments, ",Yd(e.bytes),i.length===1?`, ${i[0]}`:`, ${i.length} robots`,s!==void 0&&s>1e8?`, seen ${Nl(Date.now()/1e3-s)}`:"",Es.value.has(e.name)?", loading":""]}),G0(e)&&A(H0,{map:e,inEntry:!0})]})}var XT={ply:"PLY",las:"LAS",pcd:"PCD",mcap:"MCAP (Foxglove)",geojson:"GeoJSON",tum:"TUM path",g2o:"g2o"};function H0(n){let{map:e}=n,[t,i]=Tt("facts"),[s,r]=Tt("map"),o=async()=>{let h=await Vt(async()=>s==="map"?(await gt.mapFile(e.name,{})).blob():gt.exportMap(e.name,s));if(!h)return;let f=document.createElement("a");f.href=URL.createObjectURL(h),f.download=`${e.name}.${s}`,f.click(),setTimeout(()=>URL.revokeObjectURL(f.href),1e4)},a=[["Frame",e.frame],["Model",e.model_id],["Version",String(e.sequence)],["Robots",Object.entries(e.robots).slice(0,20).map(([h,f])=>`${h} (${it(f)})`).join(", ")]];e.time_span&&a.push(["Seen",`${ys(e.time_span[0])} to ${ys(e.time_span[1])}`]),Object.keys(e.sources).length&&a.push(["Merged from",Object.keys(e.sources).join(", ")]),e.tags.length&&a.push(["Tags",e.tags.join(", ")]);let l=so.value.get(e.name);if(l&&a.push(["Calibration",qT(l)]),l?.anchor){let{lat:h,lon:f,height:d}=l.anchor;a.push(["On Earth",`${h.toFixed(6)}, ${f.toFixed(6)}, ${d.toFixed(1)} m${l.anchor.applies?"":" (of an earlier frame)"}`])}let c=Lr(e.name),u=[["facts","Facts"],["versions","Versions"]];return u.push(["merge",c?"Align and merge":"Align"]),c&&u.push(["drift","Remove drift"],["prune","Prune"]),A("section",{class:"current-map","aria-label":`Map ${e.name}`,children:[A("h2",{class:n.inEntry?"hidden":"",children:e.name}),A("div",{class:"row",role:"group","aria-label":"Part",children:u.map(([h,f])=>A(ot,{pressed:t===h,onClick:()=>i(h),children:f},h))}),t==="facts"&&A(Ct,{children:[A("dl",{children:a.map(([h,f])=>A("div",{children:[A("dt",{children:h}),A("dd",{children:f})]},h))}),A("div",{class:"row",children:[A("label",{children:[A("span",{class:"hidden",children:"File format"}),A("select",{value:s,onChange:h=>r(h.currentTarget.value),children:[A("option",{value:"map",children:"map file"}),Object.entries(XT).map(([h,f])=>A("option",{value:h,children:f},h))]})]}),A(ot,{onClick:()=>{o()},children:"Download"})]})]}),t==="versions"&&A(z0,{map:e},e.etag),t==="merge"&&A(v0,{map:e},e.name),t==="drift"&&A(U0,{map:e},e.name),t==="prune"&&A(YT,{map:e})]})}function qT(n){if(!n.calibration)return"none: the model of the map is not loaded";let{state:e,read:t}=n.calibration;return e==="default"?"by the model":`${e}, from ${it(t)} segments`}function YT(n){let{map:e}=n,t=e.time_span,i=t!==null&&t[1]>1e8,[s,r]=Tt(i?"30":String(t?Math.floor(t[0]):0)),[o,a]=Tt(null),l=i?Date.now()/1e3-86400*Number(s):Number(s),c=async()=>{let h=await Vt(()=>gt.prune(e.name,l,!0));h&&a(h.removed)},u=async()=>{let h=await Vt(()=>gt.prune(e.name,l,!1));h&&(a(null),Hn("done",`${it(h.removed)} segments removed from ${e.name}`,"To undo this, restore the version before under Versions."),await ni())};return A(Ct,{children:[A("p",{children:["Remove segments that no robot has seen again.",t&&` The segments of this map were last seen from ${ys(t[0])} to ${ys(t[1])}.`]}),A("div",{class:"row",children:[A("label",{children:[i?"Not seen for days ":"Not seen since second ",A("input",{class:"short",type:"number",min:"0",value:s,onInput:h=>{r(h.currentTarget.value),a(null)}})]}),A(ot,{onClick:()=>{c()},children:"Preview"})]}),o!==null&&A("div",{class:"row",role:"status",children:[A("span",{class:"grow",children:[it(o)," of ",it(e.segments)," segments would be removed."]}),o>0&&A(ot,{kind:"danger",onClick:()=>{u()},children:"Remove them"})]})]})}function W0(){let n=ho.value,[e,t]=Tt(n.name.replace(/\.[^.]*$/,"").replace(/[^A-Za-z0-9._-]/g,"-").replace(/^[^A-Za-z0-9]+/,"").slice(0,64)||"map"),[i,s]=Tt(""),r=async o=>{o.preventDefault();try{await gt.uploadMap(e,n)}catch(a){if(!(a instanceof yn))throw a;s(a.status===412?`There is a map ${e} already. Choose another name.`:a.message);return}ho.value=null,Hn("done",`Map ${e} is stored`),await ni(),await mi(e)};return A(Rs,{title:"Store this map",onClose:()=>ho.value=null,children:A("form",{onSubmit:o=>{r(o)},children:[A("p",{children:[n.name,", ",Yd(n.size)]}),A("label",{children:["Name ",A("input",{required:!0,pattern:"[A-Za-z0-9][A-Za-z0-9._\\-]{0,63}",value:e,onInput:o=>t(o.currentTarget.value)})]}),i&&A("p",{role:"alert",children:i}),A("div",{class:"row",children:[A("button",{type:"submit",class:"main",children:"Store"}),A(ot,{onClick:()=>ho.value=null,children:"Cancel"})]})]})})}function X0(){let n=De();if(!n)return;let e=[];for(let t of ls.value){let i=t.map?n.layers.get(t.map):void 0;if(!i||!t.position)continue;let s=t.age>60?Kn:fh(t.robot),r=i.pose,o=r.clone().multiply(lo({translation:t.position,rotation:t.orientation??[0,0,0,1]}));e.push(...Th(o,Math.max(2,n.reach()/25),s)),t.covariance&&e.push(...wh(new V().applyMatrix4(o),t.covariance,s));let a=Cl.value.get(t.robot);if(a?.map===t.map){let l=a.places.map(c=>Ps(c).applyMatrix4(r));l.slice(1).forEach((c,u)=>e.push({from:l[u],to:c,color:s}))}}for(let t of no.value.values()){let i=n.layers.get(t.map);if(!i)continue;let s=Ps(t.position).applyMatrix4(i.pose);for(let r of t.inliers){let o=i.rowOf(r);o!==void 0&&e.push({from:s,to:i.position(o),color:Jn})}}n.overlay("robots",e)}function q0(){return A(Ct,{children:[!ls.value.length&&A("p",{children:["No robot has reported in the last minutes. Robots report while they run ",A("code",{children:"placecell robot"}),"."]}),A("ul",{class:"robots",children:ls.value.map(n=>A(jT,{robot:n},n.robot))}),A("h2",{children:"Events"}),!Hi.value.on&&A("p",{class:"warning",children:["Not connected. ",Hi.value.reason]}),A("ol",{class:"events",children:pa.value.slice(0,40).map(n=>A("li",{children:[A("time",{children:$T(n)})," ",A("span",{children:KT(n)})]},n.id))}),!pa.value.length&&A("p",{class:"facts",children:"Nothing has happened since this page was opened. Positions of robots are above; here are fixes, uploads, merges, alarms, and changes of a robot's state."})]})}function $T(n){let e=Number(n.data.received??n.data.time);return Number.isFinite(e)?new Date(1e3*e).toTimeString().slice(0,8):""}var ZT={put:"was stored whole",edit:"was edited",merge:"was merged",restore:"was restored to an earlier version",age:"was pruned",delete:"was deleted"};function KT({kind:n,data:e}){let t=r=>typeof e[r]=="string"||typeof e[r]=="number"?String(e[r]):"",i=t("robot")||(t("session")?`session ${t("session")}`:"a robot"),s=t("map");if(n==="fix")return`${i} was localized in ${s}.`;if(n==="no-fix")return`${i} was not localized: ${t("reason").replaceAll("-"," ")}.`;if(n==="robot")return`${i} is ${t("state")}${s&&e.position&&e.pose_age===e.age?` in ${s}`:""}. ${t("reason")}`;if(["upload","merge","write"].includes(n)){let r=t("segments")?` It has ${Number(t("segments")).toLocaleString("en-US")} segments.`:"";return`Map ${s} ${ZT[t("operation")]??`was changed (${t("operation")})`}.${r}`}return n==="alarm"?`Alarm ${t("alarm")} ${e.raised===!1?"has ended":"began"}. ${t("detail")}`:n==="missed"||n==="dropped"?"Some events were lost: the service was restarted, or the link was too slow.":n==="stopping"?"The service stops.":n}var JT="What to do: let the robot drive on, so that it sees more segments. If it stays lost, drop a scan from there on this page: the page shows which maps know the place.";function jT(n){let{robot:e}=n,t=e.covariance?Math.sqrt(Math.max(e.covariance[0]?.[0]??0,e.covariance[1]?.[1]??0)):null,i=_h(e),s=e.age>60,r=async()=>{if(!e.map||!e.position)return;bt.value.has(e.map)||await mi(e.map,!1),Mn.value=e.map;let o=De().layers.get(e.map);o&&De().look(Ps(e.position).applyMatrix4(o.pose),40),X0()};return A("li",{children:[A(Ol,{color:ci(e.age>60?Kn:fh(e.robot))}),A("div",{children:[A("b",{children:e.robot})," ",A("em",{class:i||s?"badge bad":"badge",children:s?`silent, was ${e.state}`:e.state}),A("span",{class:"facts",children:[e.map&&e.position?`${i?"last seen in":"in"} ${e.map} at x ${e.position[0].toFixed(1)}, y ${e.position[1].toFixed(1)}`:"no pose yet",t!==null&&!i&&`, within ${wn(2*t)}`,e.probability!==null&&!i&&`, ${Dr(e.probability)} sure`,", ",Nl(e.pose_age??e.age)]}),e.reason&&A("span",{class:"facts warning",children:e.reason})]}),e.map&&e.position&&A(ot,{onClick:()=>{r()},label:`Show ${i?"the last pose of ":""}${e.robot}`,children:i?"Last pose":"Show"}),(i||s)&&A("p",{class:"facts",children:s?`It has not reported for ${Nl(e.age).replace(" ago","")}. Check that it runs and that its link works.`:JT})]})}function Y0(){let n=[ls.value,Cl.value,no.value,bt.value,Ir.value];return Kt(X0,n),null}var rp=Ze(null);function $0(){let n=er.value,e=bt.value.get(n.map);if(!e)return null;let{row:t}=n,i=rp.value?.of===n?rp.value.candidates:null,s=[0,1,2].map(o=>e.centroids[3*t+o].toFixed(2)).join(", "),r=[["Map",e.name],["Robot",e.robots[e.robot[t]]??""],["Position",`${s} m`],["Captured",ys(hc(e,t))]];if(e.seen&&r.push(["Last seen",ys(e.seen[t])]),e.extents){let o=[0,1,2].map(a=>e.extents[3*t+a]/10);r.push(["Size",o.some(Boolean)?`${o.map(a=>a.toFixed(1)).join(" \xD7 ")} m`:"unknown"])}return e.points&&r.push(["Points",it(e.points[t])]),e.classes&&r.push(["Class",Ym(e.classes[t])]),e.source&&r.push(["From map",e.sources[e.source[t]-1]??e.name]),e.views&&e.views[t]!==e.ids[t]&&r.push(["Same object as",String(e.views[t])]),A("aside",{class:"card","aria-label":"Selected segment",children:[A("header",{children:[A("h2",{children:["Segment ",e.ids[t]]}),A(ot,{kind:"plain",onClick:()=>tr(null),title:"Key: Escape",children:"Close"})]}),A("dl",{children:r.map(([o,a])=>A("div",{children:[A("dt",{children:o}),A("dd",{children:a})]},o))}),A(ot,{onClick:()=>{eA(e,n)},children:"Find alike segments"}),i&&i.length>0&&A("p",{class:"facts",children:"Probability that it is the same object:"}),i&&(i.length?A("ol",{class:"alike",children:i.map(o=>A("li",{children:[A("button",{type:"button",class:"plain",disabled:!bt.value.has(o.map),onClick:()=>QT(o),children:[o.map," ",o.id]})," ",o.probability===null?`distance ${o.distance.toFixed(2)}`:Dr(o.probability)]},`${o.map} ${o.id}`))}):A("p",{children:"No other segment is near."}))]})}function QT(n){let e=De().layers.get(n.map)?.rowOf(n.id);e!==void 0&&tr({map:n.map,row:e})}async function eA(n,e){let i=(await Vt(async()=>gt.match({model_id:n.modelId,codes:[await Wm(n,e.row)],k:13,rerank:!1})))?.queries[0];if(!i||!("candidates"in i))return;let s=n.ids[e.row],r=i.candidates.filter(c=>c.map!==n.name||c.id!==s).slice(0,12).sort((c,u)=>(u.probability??0)-(c.probability??0));rp.value={of:e,candidates:r};let o=new Map,a=De().layers.get(n.name).position(e.row),l=[];for(let c of r){o.has(c.map)||o.set(c.map,new Map),o.get(c.map).set(c.id,c.probability??0);let u=De().layers.get(c.map),h=u?.rowOf(c.id);u&&h!==void 0&&l.push({from:a,to:u.position(h),color:Jn})}Rl.value=o,De().overlay("alike",l),yi.value==="match"&&ii()}var tA="uplot",nA="u-hz",iA="u-vt",sA="u-title",rA="u-wrap",oA="u-under",aA="u-over",lA="u-axis",mo="u-off",cA="u-select",uA="u-cursor-x",hA="u-cursor-y",fA="u-cursor-pt",dA="u-legend",pA="u-live",mA="u-inline",gA="u-series",_A="u-marker",Z0="u-label",vA="u-value",Bl="width",kl="height";var K0="bottom",xa="left",op="right",Mp="#000",J0=Mp+"0",ap="mousemove",j0="mousedown",lp="mouseup",Q0="mouseenter",ev="mouseleave",tv="dblclick",xA="resize",yA="scroll",nv="change",Lh="dppxchange",wp="--",Aa=typeof window<"u",dp=Aa?document:null,ba=Aa?window:null,bA=Aa?navigator:null,Dt,Ch;function pp(){let n=devicePixelRatio;Dt!=n&&(Dt=n,Ch&&gp(nv,Ch,pp),Ch=matchMedia(`(min-resolution: ${Dt-.001}dppx) and (max-resolution: ${Dt+.001}dppx)`),go(nv,Ch,pp),ba.dispatchEvent(new CustomEvent(Lh)))}function Li(n,e){if(e!=null){let t=n.classList;!t.contains(e)&&t.add(e)}}function mp(n,e){let t=n.classList;t.contains(e)&&t.remove(e)}function Qt(n,e,t){n.style[e]=t+"px"}function us(n,e,t,i){let s=dp.createElement(n);return e!=null&&Li(s,e),t?.insertBefore(s,i),s}function Wi(n,e){return us("div",n,e)}var iv=new WeakMap;function Is(n,e,t,i,s){let r="translate("+e+"px,"+t+"px)",o=iv.get(n);r!=o&&(n.style.transform=r,iv.set(n,r),e<0||t<0||e>i||t>s?Li(n,mo):mp(n,mo))}var sv=new WeakMap;function rv(n,e,t){let i=e+t,s=sv.get(n);i!=s&&(sv.set(n,i),n.style.background=e,n.style.borderColor=t)}var ov=new WeakMap;function av(n,e,t,i){let s=e+""+t,r=ov.get(n);s!=r&&(ov.set(n,s),n.style.height=t+"px",n.style.width=e+"px",n.style.marginLeft=i?-e/2+"px":0,n.style.marginTop=i?-t/2+"px":0)}var Tp={passive:!0},SA={...Tp,capture:!0};function go(n,e,t,i){e.addEventListener(n,t,i?SA:Tp)}function gp(n,e,t,i){e.removeEventListener(n,t,Tp)}Aa&&pp();function hs(n,e,t,i){let s;t=t||0,i=i||e.length-1;let r=i<=2147483647;for(;i-t>1;)s=r?t+i>>1:Di((t+i)/2),e[s]<n?t=s:i=s;return n-e[t]<=e[i]-n?t:i}function Uv(n){return(t,i,s)=>{let r=-1,o=-1;for(let a=i;a<=s;a++)if(n(t[a])){r=a;break}for(let a=s;a>=i;a--)if(n(t[a])){o=a;break}return[r,o]}}var Ov=n=>n!=null,Fv=n=>n!=null&&n>0,Uh=Uv(Ov),MA=Uv(Fv);function wA(n,e,t,i=0,s=!1){let r=s?MA:Uh,o=s?Fv:Ov;[e,t]=r(n,e,t);let a=n[e],l=n[e];if(e>-1)if(i==1)a=n[e],l=n[t];else if(i==-1)a=n[t],l=n[e];else for(let c=e;c<=t;c++){let u=n[c];o(u)&&(u<a?a=u:u>l&&(l=u))}return[a??Ht,l??-Ht]}function Oh(n,e,t,i){let s=uv(n),r=uv(e);n==e&&(s==-1?(n*=t,e/=t):(n/=t,e*=t));let o=t==10?ir:Bv,a=s==1?Di:Xi,l=r==1?Xi:Di,c=a(o(Nn(n))),u=l(o(Nn(e))),h=Sa(t,c),f=Sa(t,u);return t==10&&(c<0&&(h=Wt(h,-c)),u<0&&(f=Wt(f,-u))),i||t==2?(n=h*s,e=f*r):(n=Gv(n,h),e=Fh(e,f)),[n,e]}function Ap(n,e,t,i){let s=Oh(n,e,t,i);return n==0&&(s[0]=0),e==0&&(s[1]=0),s}var Ep=.1,lv={mode:3,pad:Ep},Vl={pad:0,soft:null,mode:0},TA={min:Vl,max:Vl};function Dh(n,e,t,i){return Bh(t)?cv(n,e,t):(Vl.pad=t,Vl.soft=i?0:null,Vl.mode=i?3:0,cv(n,e,TA))}function Pt(n,e){return n??e}function AA(n,e,t){for(e=Pt(e,0),t=Pt(t,n.length-1);e<=t;){if(n[e]!=null)return!0;e++}return!1}function cv(n,e,t){let i=t.min,s=t.max,r=Pt(i.pad,0),o=Pt(s.pad,0),a=Pt(i.hard,-Ht),l=Pt(s.hard,Ht),c=Pt(i.soft,Ht),u=Pt(s.soft,-Ht),h=Pt(i.mode,0),f=Pt(s.mode,0),d=e-n,g=ir(d),y=gi(Nn(n),Nn(e)),p=ir(y),m=Nn(p-g);(d<1e-24||m>10)&&(d=0,(n==0||e==0)&&(d=1e-24,h==2&&c!=Ht&&(r=0),f==2&&u!=-Ht&&(o=0)));let x=d||y||1e3,R=ir(x),S=Sa(10,Di(R)),C=x*(d==0?n==0?.1:1:r),E=Wt(Gv(n-C,S/10),24),v=n>=c&&(h==1||h==3&&E<=c||h==2&&E>=c)?c:Ht,T=gi(a,E<v&&n>=v?v:fs(v,E)),z=x*(d==0?e==0?.1:1:o),N=Wt(Fh(e+z,S/10),24),D=e<=u&&(f==1||f==3&&N>=u||f==2&&N<=u)?u:-Ht,W=fs(l,N>D&&e<=D?D:gi(D,N));return T==W&&T==0&&(W=100),[T,W]}var EA=new Intl.NumberFormat(Aa?bA.language:"en-US"),Cp=n=>EA.format(n),Ni=Math,Ih=Ni.PI,Nn=Ni.abs,Di=Ni.floor,Dn=Ni.round,Xi=Ni.ceil,fs=Ni.min,gi=Ni.max,Sa=Ni.pow,uv=Ni.sign,ir=Ni.log10,Bv=Ni.log2,CA=(n,e=1)=>Ni.sinh(n)*e,cp=(n,e=1)=>Ni.asinh(n/e),Ht=1/0;function hv(n){return(ir((n^n>>31)-(n>>31))|0)+1}function _p(n,e,t){return fs(gi(n,e),t)}function kv(n){return typeof n=="function"}function wt(n){return kv(n)?n:()=>n}var RA=()=>{},zv=n=>n,Vv=(n,e)=>e,PA=n=>null,fv=n=>!0,dv=(n,e)=>n==e,IA=/\.\d*?(?=9{6,}|0{6,})/gm,_o=n=>{if(Wv(n)||Ur.has(n))return n;let e=`${n}`,t=e.match(IA);if(t==null)return n;let i=t[0].length-1;if(e.indexOf("e-")!=-1){let[s,r]=e.split("e");return+`${_o(s)}e${r}`}return Wt(n,i)};function fo(n,e){return _o(Wt(_o(n/e))*e)}function Fh(n,e){return _o(Xi(_o(n/e))*e)}function Gv(n,e){return _o(Di(_o(n/e))*e)}function Wt(n,e=0){if(Wv(n))return n;let t=10**e,i=n*t*(1+Number.EPSILON);return Dn(i)/t}var Ur=new Map;function Hv(n){return((""+n).split(".")[1]||"").length}function Hl(n,e,t,i){let s=[],r=i.map(Hv);for(let o=e;o<t;o++){let a=Nn(o),l=Wt(Sa(n,o),a);for(let c=0;c<i.length;c++){let u=n==10?+`${i[c]}e${o}`:i[c]*l,h=(o>=0?0:a)+(o>=r[c]?0:r[c]),f=n==10?u:Wt(u,h);s.push(f),Ur.set(f,h)}}return s}var Gl={},Rp=[],Ma=[null,null],Nr=Array.isArray,Wv=Number.isInteger,LA=n=>n===void 0;function pv(n){return typeof n=="string"}function Bh(n){let e=!1;if(n!=null){let t=n.constructor;e=t==null||t==Object}return e}function DA(n){return n!=null&&typeof n=="object"}var NA=Object.getPrototypeOf(Uint8Array),Xv="__proto__";function wa(n,e=Bh){let t;if(Nr(n)){let i=n.find(s=>s!=null);if(Nr(i)||e(i)){t=Array(n.length);for(let s=0;s<n.length;s++)t[s]=wa(n[s],e)}else t=n.slice()}else if(n instanceof NA)t=n.slice();else if(e(n)){t={};for(let i in n)i!=Xv&&(t[i]=wa(n[i],e))}else t=n;return t}function Tn(n){let e=arguments;for(let t=1;t<e.length;t++){let i=e[t];for(let s in i)s!=Xv&&(Bh(n[s])?Tn(n[s],wa(i[s])):n[s]=wa(i[s]))}return n}var UA=0,OA=1,FA=2;function BA(n,e,t){for(let i=0,s,r=-1;i<e.length;i++){let o=e[i];if(o>r){for(s=o-1;s>=0&&n[s]==null;)n[s--]=null;for(s=o+1;s<t&&n[s]==null;)n[r=s++]=null}}}function kA(n,e){if(GA(n)){let o=n[0].slice();for(let a=1;a<n.length;a++)o.push(...n[a].slice(1));return HA(o[0])||(o=VA(o)),o}let t=new Set;for(let o=0;o<n.length;o++){let l=n[o][0],c=l.length;for(let u=0;u<c;u++)t.add(l[u])}let i=[Array.from(t).sort((o,a)=>o-a)],s=i[0].length,r=new Map;for(let o=0;o<s;o++)r.set(i[0][o],o);for(let o=0;o<n.length;o++){let a=n[o],l=a[0];for(let c=1;c<a.length;c++){let u=a[c],h=Array(s).fill(void 0),f=e?e[o][c]:OA,d=[];for(let g=0;g<u.length;g++){let y=u[g],p=r.get(l[g]);y===null?f!=UA&&(h[p]=y,f==FA&&d.push(p)):h[p]=y}BA(h,d,s),i.push(h)}}return i}var zA=typeof queueMicrotask>"u"?n=>Promise.resolve().then(n):queueMicrotask;function VA(n){let e=n[0],t=e.length,i=Array(t);for(let r=0;r<i.length;r++)i[r]=r;i.sort((r,o)=>e[r]-e[o]);let s=[];for(let r=0;r<n.length;r++){let o=n[r],a=Array(t);for(let l=0;l<t;l++)a[l]=o[i[l]];s.push(a)}return s}function GA(n){let e=n[0][0],t=e.length;for(let i=1;i<n.length;i++){let s=n[i][0];if(s.length!=t)return!1;if(s!=e){for(let r=0;r<t;r++)if(s[r]!=e[r])return!1}}return!0}function HA(n,e=100){let t=n.length;if(t<=1)return!0;let i=0,s=t-1;for(;i<=s&&n[i]==null;)i++;for(;s>=i&&n[s]==null;)s--;if(s<=i)return!0;let r=gi(1,Di((s-i+1)/e));for(let o=n[i],a=i+r;a<=s;a+=r){let l=n[a];if(l!=null){if(l<=o)return!1;o=l}}return!0}var qv=["January","February","March","April","May","June","July","August","September","October","November","December"],Yv=["Sunday","Monday","Tuesday","Wednesday","Thursday","Friday","Saturday"];function $v(n){return n.slice(0,3)}var WA=Yv.map($v),XA=qv.map($v),qA={MMMM:qv,MMM:XA,WWWW:Yv,WWW:WA};function Fl(n){return(n<10?"0":"")+n}function YA(n){return(n<10?"00":n<100?"0":"")+n}var $A={YYYY:n=>n.getFullYear(),YY:n=>(n.getFullYear()+"").slice(2),MMMM:(n,e)=>e.MMMM[n.getMonth()],MMM:(n,e)=>e.MMM[n.getMonth()],MM:n=>Fl(n.getMonth()+1),M:n=>n.getMonth()+1,DD:n=>Fl(n.getDate()),D:n=>n.getDate(),WWWW:(n,e)=>e.WWWW[n.getDay()],WWW:(n,e)=>e.WWW[n.getDay()],HH:n=>Fl(n.getHours()),H:n=>n.getHours(),h:n=>{let e=n.getHours();return e==0?12:e>12?e-12:e},AA:n=>n.getHours()>=12?"PM":"AM",aa:n=>n.getHours()>=12?"pm":"am",a:n=>n.getHours()>=12?"p":"a",mm:n=>Fl(n.getMinutes()),m:n=>n.getMinutes(),ss:n=>Fl(n.getSeconds()),s:n=>n.getSeconds(),fff:n=>YA(n.getMilliseconds())};function Pp(n,e){e=e||qA;let t=[],i=/\{([a-z]+)\}|[^{]+/gi,s;for(;s=i.exec(n);)t.push(s[0][0]=="{"?$A[s[1]]:s[0]);return r=>{let o="";for(let a=0;a<t.length;a++)o+=typeof t[a]=="string"?t[a]:t[a](r,e);return o}}var ZA=new Intl.DateTimeFormat().resolvedOptions().timeZone;function KA(n,e){let t;return e=="UTC"||e=="Etc/UTC"?t=new Date(+n+n.getTimezoneOffset()*6e4):e==ZA?t=n:(t=new Date(n.toLocaleString("en-US",{timeZone:e})),t.setMilliseconds(n.getMilliseconds())),t}var Zv=n=>n%1==0,Nh=[1,2,2.5,5],JA=Hl(10,-32,0,Nh),Kv=Hl(10,0,32,Nh),jA=Kv.filter(Zv),po=JA.concat(Kv),Ip=`
`,Jv="{YYYY}",mv=Ip+Jv,jv="{M}/{D}",zl=Ip+jv,Rh=zl+"/{YY}",Qv="{aa}",QA="{h}:{mm}",ya=QA+Qv,gv=Ip+ya,_v=":{ss}",Ut=null;function ex(n){let e=n*1e3,t=e*60,i=t*60,s=i*24,r=s*30,o=s*365,l=(n==1?Hl(10,0,3,Nh).filter(Zv):Hl(10,-3,0,Nh)).concat([e,e*5,e*10,e*15,e*30,t,t*5,t*10,t*15,t*30,i,i*2,i*3,i*4,i*6,i*8,i*12,s,s*2,s*3,s*4,s*5,s*6,s*7,s*8,s*9,s*10,s*15,r,r*2,r*3,r*4,r*6,o,o*2,o*5,o*10,o*25,o*50,o*100]),c=[[o,Jv,Ut,Ut,Ut,Ut,Ut,Ut,1],[s*28,"{MMM}",mv,Ut,Ut,Ut,Ut,Ut,1],[s,jv,mv,Ut,Ut,Ut,Ut,Ut,1],[i,"{h}"+Qv,Rh,Ut,zl,Ut,Ut,Ut,1],[t,ya,Rh,Ut,zl,Ut,Ut,Ut,1],[e,_v,Rh+" "+ya,Ut,zl+" "+ya,Ut,gv,Ut,1],[n,_v+".{fff}",Rh+" "+ya,Ut,zl+" "+ya,Ut,gv,Ut,1]];function u(h){return(f,d,g,y,p,m)=>{let x=[],R=p>=o,S=p>=r&&p<o,C=h(g),E=Wt(C*n,3),v=up(C.getFullYear(),R?0:C.getMonth(),S||R?1:C.getDate()),T=Wt(v*n,3);if(S||R){let z=S?p/r:0,N=R?p/o:0,D=E==T?E:Wt(up(v.getFullYear()+N,v.getMonth()+z,1)*n,3),W=new Date(Dn(D/n)),G=W.getFullYear(),U=W.getMonth();for(let X=0;D<=y;X++){let K=up(G+N*X,U+z*X,1),H=K-h(Wt(K*n,3));D=Wt((+K+H)*n,3),D<=y&&x.push(D)}}else{let z=p>=s?s:p,N=Di(g)-Di(E),D=T+N+Fh(E-T,z);x.push(D);let W=h(D),G=W.getHours()+W.getMinutes()/t+W.getSeconds()/i,U=p/i,X=f.axes[d]._space,K=m/X;for(;D=Wt(D+p,n==1?0:3),!(D>y);)if(U>1){let H=Di(Wt(G+U,6))%24,Q=h(D).getHours()-H;Q>1&&(Q=-1),D-=Q*i,G=(G+U)%24;let se=x[x.length-1];Wt((D-se)/p,3)*K>=.7&&x.push(D)}else x.push(D)}return x}}return[l,c,u]}var[eE,tE,nE]=ex(1),[iE,sE,rE]=ex(.001);Hl(2,-53,53,[1]);function vv(n,e){return n.map(t=>t.map((i,s)=>s==0||s==8||i==null?i:e(s==1||t[8]==0?i:t[1]+i)))}function xv(n,e){return(t,i,s,r,o)=>{let a=e.find(g=>o>=g[0])||e[e.length-1],l,c,u,h,f,d;return i.map(g=>{let y=n(g),p=y.getFullYear(),m=y.getMonth(),x=y.getDate(),R=y.getHours(),S=y.getMinutes(),C=y.getSeconds(),E=p!=l&&a[2]||m!=c&&a[3]||x!=u&&a[4]||R!=h&&a[5]||S!=f&&a[6]||C!=d&&a[7]||a[1];return l=p,c=m,u=x,h=R,f=S,d=C,E(y)})}}function oE(n,e){let t=Pp(e);return(i,s,r,o,a)=>s.map(l=>t(n(l)))}function up(n,e,t){return new Date(n,e,t)}function yv(n,e){return e(n)}var aE="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function bv(n,e){return(t,i,s,r)=>r==null?wp:e(n(i))}function lE(n,e){let t=n.series[e];return t.width?t.stroke(n,e):t.points.width?t.points.stroke(n,e):null}function cE(n,e){return n.series[e].fill(n,e)}var uE={show:!0,live:!0,isolate:!1,mount:RA,markers:{show:!0,width:2,stroke:lE,fill:cE,dash:"solid"},idx:null,idxs:null,values:[]};function hE(n,e){let t=n.cursor.points,i=Wi(),s=t.size(n,e);Qt(i,Bl,s),Qt(i,kl,s);let r=s/-2;Qt(i,"marginLeft",r),Qt(i,"marginTop",r);let o=t.width(n,e,s);return o&&Qt(i,"borderWidth",o),i}function fE(n,e){let t=n.series[e].points;return t._fill||t._stroke}function dE(n,e){let t=n.series[e].points;return t._stroke||t._fill}function pE(n,e){return n.series[e].points.size}var hp=[0,0];function mE(n,e,t){return hp[0]=e,hp[1]=t,hp}function Ph(n,e,t,i=!0){return s=>{s.button==0&&(!i||s.target==e)&&t(s)}}function fp(n,e,t,i=!0){return s=>{(!i||s.target==e)&&t(s)}}var gE={show:!0,x:!0,y:!0,lock:!1,move:mE,points:{one:!1,show:hE,size:pE,width:0,stroke:dE,fill:fE},bind:{mousedown:Ph,mouseup:Ph,click:Ph,dblclick:Ph,mousemove:fp,mouseleave:fp,mouseenter:fp},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(n,e)=>{e.stopPropagation(),e.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(n,e,t,i,s)=>i-s,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},tx={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},Lp=Tn({},tx,{filter:Vv}),nx=Tn({},Lp,{size:10}),ix=Tn({},tx,{show:!1}),Dp='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',sx="bold "+Dp,rx=1.5,Sv={show:!0,scale:"x",stroke:Mp,space:50,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:sx,side:2,grid:Lp,ticks:nx,border:ix,font:Dp,lineGap:rx,rotate:0},_E="Value",vE="Time",Mv={show:!0,scale:"x",auto:!1,sorted:1,min:Ht,max:-Ht,idxs:[]};function xE(n,e,t,i,s){return e.map(r=>r==null?"":Cp(r))}function yE(n,e,t,i,s,r,o){let a=[],l=Ur.get(s)||0;t=o?t:Wt(Fh(t,s),l);for(let c=t;c<=i;c=Wt(c+s,l))a.push(Object.is(c,-0)?0:c);return a}function vp(n,e,t,i,s,r,o){let a=[],l=n.scales[n.axes[e].scale].log,c=l==10?ir:Bv,u=Di(c(t));s=Sa(l,u),l==10&&(s=po[hs(s,po)]);let h=t,f=s*l;l==10&&(f=po[hs(f,po)]);do a.push(h),h=h+s,l==10&&!Ur.has(h)&&(h=Wt(h,Ur.get(s))),h>=f&&(s=h,f=s*l,l==10&&(f=po[hs(f,po)]));while(h<=i);return a}function bE(n,e,t,i,s,r,o){let l=n.scales[n.axes[e].scale].asinh,c=i>l?vp(n,e,gi(l,t),i,s):[l],u=i>=0&&t<=0?[0]:[];return(t<-l?vp(n,e,gi(l,-i),-t,s):[l]).reverse().map(f=>-f).concat(u,c)}var ox=/./,SE=/[12357]/,ME=/[125]/,wv=/1/,xp=(n,e,t,i)=>n.map((s,r)=>e==4&&s==0||r%i==0&&t.test(s.toExponential()[s<0?1:0])?s:null);function wE(n,e,t,i,s){let r=n.axes[t],o=r.scale,a=n.scales[o],l=n.valToPos,c=r._space,u=l(10,o),h=l(9,o)-u>=c?ox:l(7,o)-u>=c?SE:l(5,o)-u>=c?ME:wv;if(h==wv){let f=Nn(l(1,o)-u);if(f<c)return xp(e.slice().reverse(),a.distr,h,Xi(c/f)).reverse()}return xp(e,a.distr,h,1)}function TE(n,e,t,i,s){let r=n.axes[t],o=r.scale,a=r._space,l=n.valToPos,c=Nn(l(1,o)-l(2,o));return c<a?xp(e.slice().reverse(),3,ox,Xi(a/c)).reverse():e}function AE(n,e,t,i){return i==null?wp:e==null?"":Cp(e)}var Tv={show:!0,scale:"y",stroke:Mp,space:30,gap:5,alignTo:1,size:50,labelGap:0,labelSize:30,labelFont:sx,side:3,grid:Lp,ticks:nx,border:ix,font:Dp,lineGap:rx,rotate:0};function EE(n,e){let t=3+(n||1)*2;return Wt(t*e,3)}function CE(n,e){let{scale:t,idxs:i}=n.series[0],s=n._data[0],r=n.valToPos(s[i[0]],t,!0),o=n.valToPos(s[i[1]],t,!0),a=Nn(o-r),l=n.series[e],c=a/(l.points.space*Dt);return i[1]-i[0]<=c}var Av={scale:null,auto:!0,sorted:0,min:Ht,max:-Ht},ax=(n,e,t,i,s)=>s,Ev={show:!0,auto:!0,sorted:0,gaps:ax,alpha:1,facets:[Tn({},Av,{scale:"x"}),Tn({},Av,{scale:"y"})]},Cv={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:ax,alpha:1,points:{show:CE,filter:null},values:null,min:Ht,max:-Ht,idxs:[],path:null,clip:null};function RE(n,e,t,i,s){return t/10}var lx={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,max:null,dir:1,ori:0},PE=Tn({},lx,{time:!1,ori:1}),Rv={};function cx(n,e){let t=Rv[n];return t||(t={key:n,plots:[],sub(i){t.plots.push(i)},unsub(i){t.plots=t.plots.filter(s=>s!=i)},pub(i,s,r,o,a,l,c){for(let u=0;u<t.plots.length;u++)t.plots[u]!=s&&t.plots[u].pub(i,s,r,o,a,l,c)}},n!=null&&(Rv[n]=t)),t}var Ta=1,yp=2;function vo(n,e,t){let i=n.mode,s=n.series[e],r=i==2?n._data[e]:n._data,o=n.scales,a=n.bbox,l=r[0],c=i==2?r[1]:r[e],u=i==2?o[s.facets[0].scale]:o[n.series[0].scale],h=i==2?o[s.facets[1].scale]:o[s.scale],f=a.left,d=a.top,g=a.width,y=a.height,p=n.valToPosH,m=n.valToPosV;return u.ori==0?t(s,l,c,u,h,p,m,f,d,g,y,zh,Ea,Gh,hx,dx):t(s,l,c,u,h,m,p,d,f,y,g,Vh,Ca,Op,fx,px)}function Np(n,e){let t=0,i=0,s=Pt(n.bands,Rp);for(let r=0;r<s.length;r++){let o=s[r];o.series[0]==e?t=o.dir:o.series[1]==e&&(o.dir==1?i|=1:i|=2)}return[t,i==1?-1:i==2?1:i==3?2:0]}function IE(n,e,t,i,s){let r=n.mode,o=n.series[e],a=r==2?o.facets[1].scale:o.scale,l=n.scales[a];return s==-1?l.min:s==1?l.max:l.distr==3?l.dir==1?l.min:l.max:0}function sr(n,e,t,i,s,r){return vo(n,e,(o,a,l,c,u,h,f,d,g,y,p)=>{let m=o.pxRound,x=c.dir*(c.ori==0?1:-1),R=c.ori==0?Ea:Ca,S,C;x==1?(S=t,C=i):(S=i,C=t);let E=m(h(a[S],c,y,d)),v=m(f(l[S],u,p,g)),T=m(h(a[C],c,y,d)),z=m(f(r==1?u.max:u.min,u,p,g)),N=new Path2D(s);return R(N,T,z),R(N,E,z),R(N,E,v),N})}function kh(n,e,t,i,s,r){let o=null;if(n.length>0){o=new Path2D;let a=e==0?Gh:Op,l=t;for(let h=0;h<n.length;h++){let f=n[h];if(f[1]>f[0]){let d=f[0]-l;d>0&&a(o,l,i,d,i+r),l=f[1]}}let c=t+s-l,u=10;c>0&&a(o,l,i-u/2,c,i+r+u)}return o}function LE(n,e,t){let i=n[n.length-1];i&&i[0]==e?i[1]=t:n.push([e,t])}function Up(n,e,t,i,s,r,o){let a=[],l=n.length;for(let c=s==1?t:i;c>=t&&c<=i;c+=s)if(e[c]===null){let h=c,f=c;if(s==1)for(;++c<=i&&e[c]===null;)f=c;else for(;--c>=t&&e[c]===null;)f=c;let d=r(n[h]),g=f==h?d:r(n[f]),y=h-s;d=o<=0&&y>=0&&y<l?r(n[y]):d;let m=f+s;g=o>=0&&m>=0&&m<l?r(n[m]):g,g>=d&&a.push([d,g])}return a}function Pv(n){return n==0?zv:n==1?Dn:e=>fo(e,n)}function ux(n){let e=n==0?zh:Vh,t=n==0?(s,r,o,a,l,c)=>{s.arcTo(r,o,a,l,c)}:(s,r,o,a,l,c)=>{s.arcTo(o,r,l,a,c)},i=n==0?(s,r,o,a,l)=>{s.rect(r,o,a,l)}:(s,r,o,a,l)=>{s.rect(o,r,l,a)};return(s,r,o,a,l,c=0,u=0)=>{c==0&&u==0?i(s,r,o,a,l):(c=fs(c,a/2,l/2),u=fs(u,a/2,l/2),e(s,r+c,o),t(s,r+a,o,r+a,o+l,c),t(s,r+a,o+l,r,o+l,u),t(s,r,o+l,r,o,u),t(s,r,o,r+a,o,c),s.closePath())}}var zh=(n,e,t)=>{n.moveTo(e,t)},Vh=(n,e,t)=>{n.moveTo(t,e)},Ea=(n,e,t)=>{n.lineTo(e,t)},Ca=(n,e,t)=>{n.lineTo(t,e)},Gh=ux(0),Op=ux(1),hx=(n,e,t,i,s,r)=>{n.arc(e,t,i,s,r)},fx=(n,e,t,i,s,r)=>{n.arc(t,e,i,s,r)},dx=(n,e,t,i,s,r,o)=>{n.bezierCurveTo(e,t,i,s,r,o)},px=(n,e,t,i,s,r,o)=>{n.bezierCurveTo(t,e,s,i,o,r)};function mx(n){return(e,t,i,s,r)=>vo(e,t,(o,a,l,c,u,h,f,d,g,y,p)=>{let{pxRound:m,points:x}=o,R,S;c.ori==0?(R=zh,S=hx):(R=Vh,S=fx);let C=Wt(x.width*Dt,3),E=(x.size-x.width)/2*Dt,v=Wt(E*2,3),T=new Path2D,z=new Path2D,{left:N,top:D,width:W,height:G}=e.bbox;Gh(z,N-v,D-v,W+v*2,G+v*2);let U=X=>{if(l[X]!=null){let K=m(h(a[X],c,y,d)),H=m(f(l[X],u,p,g));R(T,K+E,H),S(T,K,H,E,0,Ih*2)}};if(r)r.forEach(U);else for(let X=i;X<=s;X++)U(X);return{stroke:C>0?T:null,fill:T,clip:z,flags:Ta|yp}})}function gx(n){return(e,t,i,s,r,o)=>{i!=s&&(r!=i&&o!=i&&n(e,t,i),r!=s&&o!=s&&n(e,t,s),n(e,t,o))}}var DE=gx(Ea),NE=gx(Ca);function _x(n){let e=Pt(n?.alignGaps,0);return(t,i,s,r)=>vo(t,i,(o,a,l,c,u,h,f,d,g,y,p)=>{[s,r]=Uh(l,s,r);let m=o.pxRound,x=G=>m(h(G,c,y,d)),R=G=>m(f(G,u,p,g)),S,C;c.ori==0?(S=Ea,C=DE):(S=Ca,C=NE);let E=c.dir*(c.ori==0?1:-1),v={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:Ta},T=v.stroke,z=!1;if(r-s>=y*4){let G=he=>t.posToVal(he,c.key,!0),U=null,X=null,K,H,ce,J=x(a[E==1?s:r]),Q=x(a[s]),se=x(a[r]),fe=G(E==1?Q+1:se-1);for(let he=E==1?s:r;he>=s&&he<=r;he+=E){let ee=a[he],ve=(E==1?ee<fe:ee>fe)?J:x(ee),Ee=l[he];ve==J?Ee!=null?(H=Ee,U==null?(S(T,ve,R(H)),K=U=X=H):H<U?U=H:H>X&&(X=H)):Ee===null&&(z=!0):(U!=null&&C(T,J,R(U),R(X),R(K),R(H)),Ee!=null?(H=Ee,S(T,ve,R(H)),U=X=K=H):(U=X=null,Ee===null&&(z=!0)),J=ve,fe=G(J+E))}U!=null&&U!=X&&ce!=J&&C(T,J,R(U),R(X),R(K),R(H))}else for(let G=E==1?s:r;G>=s&&G<=r;G+=E){let U=l[G];U===null?z=!0:U!=null&&S(T,x(a[G]),R(U))}let[D,W]=Np(t,i);if(o.fill!=null||D!=0){let G=v.fill=new Path2D(T),U=o.fillTo(t,i,o.min,o.max,D),X=R(U),K=x(a[s]),H=x(a[r]);E==-1&&([H,K]=[K,H]),S(G,H,X),S(G,K,X)}if(!o.spanGaps){let G=[];z&&G.push(...Up(a,l,s,r,E,x,e)),v.gaps=G=o.gaps(t,i,s,r,G),v.clip=kh(G,c.ori,d,g,y,p)}return W!=0&&(v.band=W==2?[sr(t,i,s,r,T,-1),sr(t,i,s,r,T,1)]:sr(t,i,s,r,T,W)),v})}function UE(n){let e=Pt(n.align,1),t=Pt(n.ascDesc,!1),i=Pt(n.alignGaps,0),s=Pt(n.extend,!1);return(r,o,a,l)=>vo(r,o,(c,u,h,f,d,g,y,p,m,x,R)=>{[a,l]=Uh(h,a,l);let S=c.pxRound,{left:C,width:E}=r.bbox,v=Q=>S(g(Q,f,x,p)),T=Q=>S(y(Q,d,R,m)),z=f.ori==0?Ea:Ca,N={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:Ta},D=N.stroke,W=f.dir*(f.ori==0?1:-1),G=T(h[W==1?a:l]),U=v(u[W==1?a:l]),X=U,K=U;s&&e==-1&&(K=C,z(D,K,G)),z(D,U,G);for(let Q=W==1?a:l;Q>=a&&Q<=l;Q+=W){let se=h[Q];if(se==null)continue;let fe=v(u[Q]),he=T(se);e==1?z(D,fe,G):z(D,X,he),z(D,fe,he),G=he,X=fe}let H=X;s&&e==1&&(H=C+E,z(D,H,G));let[ce,J]=Np(r,o);if(c.fill!=null||ce!=0){let Q=N.fill=new Path2D(D),se=c.fillTo(r,o,c.min,c.max,ce),fe=T(se);z(Q,H,fe),z(Q,K,fe)}if(!c.spanGaps){let Q=[];Q.push(...Up(u,h,a,l,W,v,i));let se=c.width*Dt/2,fe=t||e==1?se:-se,he=t||e==-1?-se:se;Q.forEach(ee=>{ee[0]+=fe,ee[1]+=he}),N.gaps=Q=c.gaps(r,o,a,l,Q),N.clip=kh(Q,f.ori,p,m,x,R)}return J!=0&&(N.band=J==2?[sr(r,o,a,l,D,-1),sr(r,o,a,l,D,1)]:sr(r,o,a,l,D,J)),N})}function Iv(n,e,t,i,s,r,o=Ht){if(n.length>1){let a=null;for(let l=0,c=1/0;l<n.length;l++)if(e[l]!==void 0){if(a!=null){let u=Nn(n[l]-n[a]);u<c&&(c=u,o=Nn(t(n[l],i,s,r)-t(n[a],i,s,r)))}a=l}}return o}function OE(n){n=n||Gl;let e=Pt(n.size,[.6,Ht,1]),t=n.align||0,i=n.gap||0,s=n.radius;s=s==null?[0,0]:typeof s=="number"?[s,0]:s;let r=wt(s),o=1-e[0],a=Pt(e[1],Ht),l=Pt(e[2],1),c=Pt(n.disp,Gl),u=Pt(n.each,d=>{}),{fill:h,stroke:f}=c;return(d,g,y,p)=>vo(d,g,(m,x,R,S,C,E,v,T,z,N,D)=>{let W=m.pxRound,G=t,U=i*Dt,X=a*Dt,K=l*Dt,H,ce;S.ori==0?[H,ce]=r(d,g):[ce,H]=r(d,g);let J=S.dir*(S.ori==0?1:-1),Q=S.ori==0?Gh:Op,se=S.ori==0?u:(Re,$e,lt,Me,Gt,Ve,qe)=>{u(Re,$e,lt,Gt,Me,qe,Ve)},fe=Pt(d.bands,Rp).find(Re=>Re.series[0]==g),he=fe!=null?fe.dir:0,ee=m.fillTo(d,g,m.min,m.max,he),me=W(v(ee,C,D,z)),ve,Ee,Se,We=N,at=W(m.width*Dt),Ge=!1,dt=null,ut=null,st=null,en=null;h!=null&&(at==0||f!=null)&&(Ge=!0,dt=h.values(d,g,y,p),ut=new Map,new Set(dt).forEach(Re=>{Re!=null&&ut.set(Re,new Path2D)}),at>0&&(st=f.values(d,g,y,p),en=new Map,new Set(st).forEach(Re=>{Re!=null&&en.set(Re,new Path2D)})));let{x0:Xt,size:dn}=c;if(Xt!=null&&dn!=null){G=1,x=Xt.values(d,g,y,p),Xt.unit==2&&(x=x.map(lt=>d.posToVal(T+lt*N,S.key,!0)));let Re=dn.values(d,g,y,p);dn.unit==2?Ee=Re[0]*N:Ee=E(Re[0],S,N,T)-E(0,S,N,T),We=Iv(x,R,E,S,N,T,We),Se=We-Ee+U}else We=Iv(x,R,E,S,N,T,We),Se=We*o+U,Ee=We-Se;Se<1&&(Se=0),at>=Ee/2&&(at=0),Se<5&&(W=zv);let kt=Se>0,Un=We-Se-(kt?at:0);Ee=W(_p(Un,K,X)),ve=(G==0?Ee/2:G==J?0:Ee)-G*J*((G==0?U/2:0)+(kt?at/2:0));let At={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},An=Ge?null:new Path2D,on=null;if(fe!=null)on=d.data[fe.series[1]];else{let{y0:Re,y1:$e}=c;Re!=null&&$e!=null&&(R=$e.values(d,g,y,p),on=Re.values(d,g,y,p))}let pn=H*Ee,F=ce*Ee;for(let Re=J==1?y:p;Re>=y&&Re<=p;Re+=J){let $e=R[Re];if($e==null)continue;if(on!=null){let q=on[Re]??0;if($e-q==0)continue;me=v(q,C,D,z)}let lt=S.distr!=2||c!=null?x[Re]:Re,Me=E(lt,S,N,T),Gt=v(Pt($e,ee),C,D,z),Ve=W(Me-ve),qe=W(gi(Gt,me)),P=W(fs(Gt,me)),b=qe-P;if($e!=null){let q=$e<0?F:pn,ue=$e<0?pn:F;Ge?(at>0&&st[Re]!=null&&Q(en.get(st[Re]),Ve,P+Di(at/2),Ee,gi(0,b-at),q,ue),dt[Re]!=null&&Q(ut.get(dt[Re]),Ve,P+Di(at/2),Ee,gi(0,b-at),q,ue)):Q(An,Ve,P+Di(at/2),Ee,gi(0,b-at),q,ue),se(d,g,Re,Ve-at/2,P,Ee+at,b)}}return at>0?At.stroke=Ge?en:An:Ge||(At._fill=m.width==0?m._fill:m._stroke??m._fill,At.width=0),At.fill=Ge?ut:An,At})}function FE(n,e){let t=Pt(e?.alignGaps,0);return(i,s,r,o)=>vo(i,s,(a,l,c,u,h,f,d,g,y,p,m)=>{[r,o]=Uh(c,r,o);let x=a.pxRound,R=H=>x(f(H,u,p,g)),S=H=>x(d(H,h,m,y)),C,E,v;u.ori==0?(C=zh,v=Ea,E=dx):(C=Vh,v=Ca,E=px);let T=u.dir*(u.ori==0?1:-1),z=R(l[T==1?r:o]),N=z,D=[],W=[];for(let H=T==1?r:o;H>=r&&H<=o;H+=T)if(c[H]!=null){let J=l[H],Q=R(J);D.push(N=Q),W.push(S(c[H]))}let G={stroke:n(D,W,C,v,E,x),fill:null,clip:null,band:null,gaps:null,flags:Ta},U=G.stroke,[X,K]=Np(i,s);if(a.fill!=null||X!=0){let H=G.fill=new Path2D(U),ce=a.fillTo(i,s,a.min,a.max,X),J=S(ce);v(H,N,J),v(H,z,J)}if(!a.spanGaps){let H=[];H.push(...Up(l,c,r,o,T,R,t)),G.gaps=H=a.gaps(i,s,r,o,H),G.clip=kh(H,u.ori,g,y,p,m)}return K!=0&&(G.band=K==2?[sr(i,s,r,o,U,-1),sr(i,s,r,o,U,1)]:sr(i,s,r,o,U,K)),G})}function BE(n){return FE(kE,n)}function kE(n,e,t,i,s,r){let o=n.length;if(o<2)return null;let a=new Path2D;if(t(a,n[0],e[0]),o==2)i(a,n[1],e[1]);else{let l=Array(o),c=Array(o-1),u=Array(o-1),h=Array(o-1);for(let f=0;f<o-1;f++)u[f]=e[f+1]-e[f],h[f]=n[f+1]-n[f],c[f]=u[f]/h[f];l[0]=c[0];for(let f=1;f<o-1;f++)c[f]===0||c[f-1]===0||c[f-1]>0!=c[f]>0?l[f]=0:(l[f]=3*(h[f-1]+h[f])/((2*h[f]+h[f-1])/c[f-1]+(h[f]+2*h[f-1])/c[f]),isFinite(l[f])||(l[f]=0));l[o-1]=c[o-2];for(let f=0;f<o-1;f++)s(a,n[f]+h[f]/3,e[f]+l[f]*h[f]/3,n[f+1]-h[f]/3,e[f+1]-l[f+1]*h[f]/3,n[f+1],e[f+1])}return a}var bp=new Set;function Lv(){for(let n of bp)n.syncRect(!0)}Aa&&(go(xA,ba,Lv),go(yA,ba,Lv,!0),go(Lh,ba,()=>{Yn.pxRatio=Dt}));var zE=_x(),VE=mx();function Dv(n,e,t,i){return(i?[n[0],n[1]].concat(n.slice(2)):[n[0]].concat(n.slice(1))).map((r,o)=>Sp(r,o,e,t))}function GE(n,e){return n.map((t,i)=>i==0?{}:Tn({},e,t))}function Sp(n,e,t,i){return Tn({},e==0?t:i,n)}function vx(n,e,t){return e==null?Ma:[e,t]}var HE=vx;function WE(n,e,t){return e==null?Ma:Dh(e,t,Ep,!0)}function xx(n,e,t,i){return e==null?Ma:Oh(e,t,n.scales[i].log,!1)}var XE=xx;function yx(n,e,t,i){return e==null?Ma:Ap(e,t,n.scales[i].log,!1)}var qE=yx;function YE(n,e,t,i,s){let r=gi(hv(n),hv(e)),o=e-n,a=hs(s/i*o,t);do{let l=t[a],c=i*l/o;if(c>=s&&r+(l<5?Ur.get(l):0)<=17)return[l,c]}while(++a<t.length);return[0,0]}function Nv(n){let e,t;return n=n.replace(/(\d+)px/,(i,s)=>(e=Dn((t=+s)*Dt))+"px"),[n,e,t]}function $E(n){n.show&&[n.font,n.labelFont].forEach(e=>{let t=Wt(e[2]*Dt,1);e[0]=e[0].replace(/[0-9.]+px/,t+"px"),e[1]=t})}function Yn(n,e,t){let i={mode:Pt(n.mode,1)},s=i.mode;function r(_,M,I,L){let k=M.valToPct(_);return L+I*(M.dir==-1?1-k:k)}function o(_,M,I,L){let k=M.valToPct(_);return L+I*(M.dir==-1?k:1-k)}function a(_,M,I,L){return M.ori==0?r(_,M,I,L):o(_,M,I,L)}i.valToPosH=r,i.valToPosV=o;let l=!1;i.status=0;let c=i.root=Wi(tA);if(n.id!=null&&(c.id=n.id),Li(c,n.class),n.title){let _=Wi(sA,c);_.textContent=n.title}let u=us("canvas"),h=i.ctx=u.getContext("2d"),f=Wi(rA,c);go("click",f,_=>{_.target===g&&(Yt!=To||tn!=Ao)&&Wn.click(i,_)},!0);let d=i.under=Wi(oA,f);f.appendChild(u);let g=i.over=Wi(aA,f);n=wa(n);let y=+Pt(n.pxAlign,1),p=Pv(y);(n.plugins||[]).forEach(_=>{_.opts&&(n=_.opts(i,n)||n)});let m=n.ms||.001,x=i.series=s==1?Dv(n.series||[],Mv,Cv,!1):GE(n.series||[null],Ev),R=i.axes=Dv(n.axes||[],Sv,Tv,!0),S=i.scales={},C=i.bands=n.bands||[];C.forEach(_=>{_.fill=wt(_.fill||null),_.dir=Pt(_.dir,-1)});let E=s==2?x[1].facets[0].scale:x[0].scale,v={axes:Us,series:mt},T=(n.drawOrder||["axes","series"]).map(_=>v[_]);function z(_){let M=_.distr==3?I=>ir(I>0?I:_.clamp(i,I,_.min,_.max,_.key)):_.distr==4?I=>cp(I,_.asinh):_.distr==100?I=>_.fwd(I):I=>I;return I=>{let L=M(I),{_min:k,_max:Z}=_,ae=Z-k;return(L-k)/ae}}function N(_){let M=S[_];if(M==null){let I=(n.scales||Gl)[_]||Gl;if(I.from!=null){N(I.from);let L=Tn({},S[I.from],I,{key:_});L.valToPct=z(L),S[_]=L}else{M=S[_]=Tn({},_==E?lx:PE,I),M.key=_;let L=M.time,k=M.range,Z=Nr(k);if((_!=E||s==2&&!L)&&(Z&&(k[0]==null||k[1]==null)&&(k={min:k[0]==null?lv:{mode:1,hard:k[0],soft:k[0]},max:k[1]==null?lv:{mode:1,hard:k[1],soft:k[1]}},Z=!1),!Z&&Bh(k))){let ae=k;k=(de,ye,Ne)=>ye==null?Ma:Dh(ye,Ne,ae)}M.range=wt(k||(L?HE:_==E?M.distr==3?XE:M.distr==4?qE:vx:M.distr==3?xx:M.distr==4?yx:WE)),M.auto=wt(Z?!1:M.auto),M.clamp=wt(M.clamp||RE),M._min=M._max=null,M.valToPct=z(M)}}}N("x"),N("y"),s==1&&x.forEach(_=>{N(_.scale)}),R.forEach(_=>{N(_.scale)});for(let _ in n.scales)N(_);let D=S[E],W=D.distr,G,U;D.ori==0?(Li(c,nA),G=r,U=o):(Li(c,iA),G=o,U=r);let X={};for(let _ in S){let M=S[_];(M.min!=null||M.max!=null)&&(X[_]={min:M.min,max:M.max},M.min=M.max=null)}let K=n.tzDate||(_=>new Date(Dn(_/m))),H=n.fmtDate||Pp,ce=m==1?nE(K):rE(K),J=xv(K,vv(m==1?tE:sE,H)),Q=bv(K,yv(aE,H)),se=[],fe=i.legend=Tn({},uE,n.legend),he=i.cursor=Tn({},gE,{drag:{y:s==2}},n.cursor),ee=fe.show,me=he.show,ve=fe.markers;fe.idxs=se,ve.width=wt(ve.width),ve.dash=wt(ve.dash),ve.stroke=wt(ve.stroke),ve.fill=wt(ve.fill);let Ee,Se,We,at=[],Ge=[],dt,ut=!1,st={};if(fe.live){let _=x[1]?x[1].values:null;ut=_!=null,dt=ut?_(i,1,0):{_:0};for(let M in dt)st[M]=wp}if(ee)if(Ee=us("table",dA,c),We=us("tbody",null,Ee),fe.mount(i,Ee),ut){Se=us("thead",null,Ee,We);let _=us("tr",null,Se);us("th",null,_);for(var en in dt)us("th",Z0,_).textContent=en}else Li(Ee,mA),fe.live&&Li(Ee,pA);let Xt={show:!0},dn={show:!1};function kt(_,M){if(M==0&&(ut||!fe.live||s==2))return Ma;let I=[],L=us("tr",gA,We,We.childNodes[M]);Li(L,_.class),_.show||Li(L,mo);let k=us("th",null,L);if(ve.show){let de=Wi(_A,k);if(M>0){let ye=ve.width(i,M);ye&&(de.style.border=ye+"px "+ve.dash(i,M)+" "+ve.stroke(i,M)),de.style.background=ve.fill(i,M)}}let Z=Wi(Z0,k);_.label instanceof HTMLElement?Z.appendChild(_.label):Z.textContent=_.label,M>0&&(ve.show||(Z.style.color=_.width>0?ve.stroke(i,M):ve.fill(i,M)),At("click",k,de=>{if(he._lock)return;Je(de);let ye=x.indexOf(_);if((de.ctrlKey||de.metaKey)!=fe.isolate){let Ne=x.some((Ue,Fe)=>Fe>0&&Fe!=ye&&Ue.show);x.forEach((Ue,Fe)=>{Fe>0&&gs(Fe,Ne?Fe==ye?Xt:dn:Xt,!0,vn.setSeries)})}else gs(ye,{show:!_.show},!0,vn.setSeries)},!1),je&&At(Q0,k,de=>{he._lock||(Je(de),gs(x.indexOf(_),Co,!0,vn.setSeries))},!1));for(var ae in dt){let de=us("td",vA,L);de.textContent="--",I.push(de)}return[L,I]}let Un=new Map;function At(_,M,I,L=!0){let k=Un.get(M)||{},Z=he.bind[_](i,M,I,L);Z&&(go(_,M,k[_]=Z),Un.set(M,k))}function An(_,M,I){let L=Un.get(M)||{};for(let k in L)(_==null||k==_)&&(gp(k,M,L[k]),delete L[k]);_==null&&Un.delete(M)}let on=0,pn=0,F=0,Re=0,$e=0,lt=0,Me=$e,Gt=lt,Ve=F,qe=Re,P=0,b=0,q=0,ue=0;i.bbox={};let oe=!1,_e=!1,xe=!1,te=!1,ie=!1,pe=!1;function O(_,M,I){(I||_!=i.width||M!=i.height)&&re(_,M),ht(!1),xe=!0,_e=!0,$n()}function re(_,M){i.width=on=F=_,i.height=pn=Re=M,$e=lt=0,be(),He();let I=i.bbox;P=I.left=fo($e*Dt,.5),b=I.top=fo(lt*Dt,.5),q=I.width=fo(F*Dt,.5),ue=I.height=fo(Re*Dt,.5)}let ne=3;function we(){let _=!1,M=0;for(;!_;){M++;let I=So(M),L=ms(M);_=M==ne||I&&L,_||(re(i.width,i.height),_e=!0)}}function ge({width:_,height:M}){O(_,M)}i.setSize=ge;function be(){let _=!1,M=!1,I=!1,L=!1;R.forEach((k,Z)=>{if(k.show&&k._show){let{side:ae,_size:de}=k,ye=ae%2,Ne=k.label!=null?k.labelSize:0,Ue=de+Ne;Ue>0&&(ye?(F-=Ue,ae==3?($e+=Ue,L=!0):I=!0):(Re-=Ue,ae==0?(lt+=Ue,_=!0):M=!0))}}),ds[0]=_,ds[1]=I,ds[2]=M,ds[3]=L,F-=qi[1]+qi[3],$e+=qi[3],Re-=qi[2]+qi[0],lt+=qi[0]}function He(){let _=$e+F,M=lt+Re,I=$e,L=lt;function k(Z,ae){switch(Z){case 1:return _+=ae,_-ae;case 2:return M+=ae,M-ae;case 3:return I-=ae,I+ae;case 0:return L-=ae,L+ae}}R.forEach((Z,ae)=>{if(Z.show&&Z._show){let de=Z.side;Z._pos=k(de,Z._size),Z.label!=null&&(Z._lpos=k(de,Z.labelSize))}})}if(he.dataIdx==null){let _=he.hover,M=_.skip=new Set(_.skip??[]);M.add(void 0);let I=_.prox=wt(_.prox),L=_.bias??=0;he.dataIdx=(k,Z,ae,de)=>{if(Z==0)return ae;let ye=ae,Ne=I(k,Z,ae,de)??Ht,Ue=Ne>=0&&Ne<Ht,Fe=D.ori==0?F:Re,rt=he.left,It=e[0],Rt=e[Z];if(M.has(Rt[ae])){ye=null;let xt=null,Ke=null,Xe;if(L==0||L==-1)for(Xe=ae;xt==null&&Xe-- >0;)M.has(Rt[Xe])||(xt=Xe);if(L==0||L==1)for(Xe=ae;Ke==null&&Xe++<Rt.length;)M.has(Rt[Xe])||(Ke=Xe);if(xt!=null||Ke!=null)if(Ue){let Zt=xt==null?-1/0:G(It[xt],D,Fe,0),cn=Ke==null?1/0:G(It[Ke],D,Fe,0),kn=rt-Zt,zt=cn-rt;kn<=zt?kn<=Ne&&(ye=xt):zt<=Ne&&(ye=Ke)}else ye=Ke==null?xt:xt==null?Ke:ae-xt<=Ke-ae?xt:Ke}else Ue&&Nn(rt-G(It[ae],D,Fe,0))>Ne&&(ye=null);return ye}}let Je=_=>{he.event=_};he.idxs=se,he._lock=!1;let le=he.points;le.show=wt(le.show),le.size=wt(le.size),le.stroke=wt(le.stroke),le.width=wt(le.width),le.fill=wt(le.fill);let Be=i.focus=Tn({},n.focus||{alpha:.3},he.focus),je=Be.prox>=0,Ce=je&&le.one,ct=[],qt=[],si=[];function Pa(_,M){let I=le.show(i,M);if(I instanceof HTMLElement)return Li(I,fA),Li(I,_.class),Is(I,-10,-10,F,Re),g.insertBefore(I,ct[M]),I}function xo(_,M){if(s==1||M>0){let I=s==1&&S[_.scale].time,L=_.value;_.value=I?pv(L)?bv(K,yv(L,H)):L||Q:L||AE,_.label=_.label||(I?vE:_E)}if(Ce||M>0){_.width=_.width==null?1:_.width,_.paths=_.paths||zE||PA,_.fillTo=wt(_.fillTo||IE),_.pxAlign=+Pt(_.pxAlign,y),_.pxRound=Pv(_.pxAlign),_.stroke=wt(_.stroke||null),_.fill=wt(_.fill||null),_._stroke=_._fill=_._paths=_._focus=null;let I=EE(gi(1,_.width),1),L=_.points=Tn({},{size:I,width:gi(1,I*.2),stroke:_.stroke,space:I*2,paths:VE,_stroke:null,_fill:null},_.points);L.show=wt(L.show),L.filter=wt(L.filter),L.fill=wt(L.fill),L.stroke=wt(L.stroke),L.paths=wt(L.paths),L.pxAlign=_.pxAlign}if(ee){let I=kt(_,M);at.splice(M,0,I[0]),Ge.splice(M,0,I[1]),fe.values.push(null)}if(me){se.splice(M,0,null);let I=null;Ce?M==0&&(I=Pa(_,M)):M>0&&(I=Pa(_,M)),ct.splice(M,0,I),qt.splice(M,0,0),si.splice(M,0,0)}Bn("addSeries",M)}function Hh(_,M){M=M??x.length,_=s==1?Sp(_,M,Mv,Cv):Sp(_,M,{},Ev),x.splice(M,0,_),xo(x[M],M)}i.addSeries=Hh;function Wl(_){if(x.splice(_,1),ee){fe.values.splice(_,1),Ge.splice(_,1);let M=at.splice(_,1)[0];An(null,M.firstChild),M.remove()}me&&(se.splice(_,1),ct.splice(_,1)[0].remove(),qt.splice(_,1),si.splice(_,1)),Bn("delSeries",_)}i.delSeries=Wl;let ds=[!1,!1,!1,!1];function Ls(_,M){if(_._show=_.show,_.show){let I=_.side%2,L=S[_.scale];L==null&&(_.scale=I?x[1].scale:E,L=S[_.scale]);let k=L.time;_.size=wt(_.size),_.space=wt(_.space),_.rotate=wt(_.rotate),Nr(_.incrs)&&_.incrs.forEach(ae=>{!Ur.has(ae)&&Ur.set(ae,Hv(ae))}),_.incrs=wt(_.incrs||(L.distr==2?jA:k?m==1?eE:iE:po)),_.splits=wt(_.splits||(k&&L.distr==1?ce:L.distr==3?vp:L.distr==4?bE:yE)),_.stroke=wt(_.stroke),_.grid.stroke=wt(_.grid.stroke),_.ticks.stroke=wt(_.ticks.stroke),_.border.stroke=wt(_.border.stroke);let Z=_.values;_.values=Nr(Z)&&!Nr(Z[0])?wt(Z):k?Nr(Z)?xv(K,vv(Z,H)):pv(Z)?oE(K,Z):Z||J:Z||xE,_.filter=wt(_.filter||(L.distr>=3&&L.log==10?wE:L.distr==3&&L.log==2?TE:Vv)),_.font=Nv(_.font),_.labelFont=Nv(_.labelFont),_._size=_.size(i,null,M,0),_._space=_._rotate=_._incrs=_._found=_._splits=_._values=null,_._size>0&&(ds[M]=!0,_._el=Wi(lA,f))}}function Ds(_,M,I,L){let[k,Z,ae,de]=I,ye=M%2,Ne=0;return ye==0&&(de||Z)&&(Ne=M==0&&!k||M==2&&!ae?Dn(Sv.size/3):0),ye==1&&(k||ae)&&(Ne=M==1&&!Z||M==3&&!de?Dn(Tv.size/2):0),Ne}let Ia=i.padding=(n.padding||[Ds,Ds,Ds,Ds]).map(_=>wt(Pt(_,Ds))),qi=i._padding=Ia.map((_,M)=>_(i,M,ds,0)),an,hn=null,fn=null,ps=s==1?x[0].idxs:null,Si=null,rr=!1;function La(_,M){if(e=_??[],i.data=i._data=e,s==2){an=0;for(let I=1;I<x.length;I++)an+=e[I][0].length}else{e.length==0&&(i.data=i._data=e=[[]]),Si=e[0],an=Si.length;let I=e;if(W==2){I=e.slice();let L=I[0]=Array(an);for(let k=0;k<an;k++)L[k]=k}i._data=e=I}if(ht(!0),Bn("setData"),W==2&&(xe=!0),M!==!1){let I=D;I.auto(i,rr)?Da():lr(E,I.min,I.max),te=te||he.left>=0,pe=!0,$n()}}i.setData=La;function Da(){rr=!0;let _,M;s==1&&(an>0?(hn=ps[0]=0,fn=ps[1]=an-1,_=e[0][hn],M=e[0][fn],W==2?(_=hn,M=fn):_==M&&(W==3?[_,M]=Oh(_,_,D.log,!1):W==4?[_,M]=Ap(_,_,D.log,!1):D.time?M=_+Dn(86400/m):[_,M]=Dh(_,M,Ep,!0))):(hn=ps[0]=_=null,fn=ps[1]=M=null)),lr(E,_,M)}let yo,or,bo,w,B,j,Y,$,Te,Pe;function Ae(_,M,I,L,k,Z){_??=J0,I??=Rp,L??="butt",k??=J0,Z??="round",_!=yo&&(h.strokeStyle=yo=_),k!=or&&(h.fillStyle=or=k),M!=bo&&(h.lineWidth=bo=M),Z!=B&&(h.lineJoin=B=Z),L!=j&&(h.lineCap=j=L),I!=w&&h.setLineDash(w=I)}function Ie(_,M,I,L){M!=or&&(h.fillStyle=or=M),_!=Y&&(h.font=Y=_),I!=$&&(h.textAlign=$=I),L!=Te&&(h.textBaseline=Te=L)}function ze(_,M,I,L,k=0){if(L.length>0&&_.auto(i,rr)&&(M==null||M.min==null)){let Z=Pt(hn,0),ae=Pt(fn,L.length-1),de=I.min==null?wA(L,Z,ae,k,_.distr==3):[I.min,I.max];_.min=fs(_.min,I.min=de[0]),_.max=gi(_.max,I.max=de[1])}}let et={min:null,max:null};function pt(){for(let L in S){let k=S[L];X[L]==null&&(k.min==null||X[E]!=null&&k.auto(i,rr))&&(X[L]=et)}for(let L in S){let k=S[L];X[L]==null&&k.from!=null&&X[k.from]!=null&&(X[L]=et)}X[E]!=null&&ht(!0);let _={};for(let L in X){let k=X[L];if(k!=null){let Z=_[L]=wa(S[L],DA);if(k.min!=null)Tn(Z,k);else if(L!=E||s==2)if(an==0&&Z.from==null){let ae=Z.range(i,null,null,L);Z.min=ae[0],Z.max=ae[1]}else Z.min=Ht,Z.max=-Ht}}if(an>0){x.forEach((L,k)=>{if(s==1){let Z=L.scale,ae=X[Z];if(ae==null)return;let de=_[Z];if(k==0){let ye=de.range(i,de.min,de.max,Z);de.min=ye[0],de.max=ye[1],hn=hs(de.min,e[0]),fn=hs(de.max,e[0]),fn-hn>1&&(e[0][hn]<de.min&&hn++,e[0][fn]>de.max&&fn--),L.min=Si[hn],L.max=Si[fn]}else L.show&&L.auto&&ze(de,ae,L,e[k],L.sorted);L.idxs[0]=hn,L.idxs[1]=fn}else if(k>0&&L.show&&L.auto){let[Z,ae]=L.facets,de=Z.scale,ye=ae.scale,[Ne,Ue]=e[k],Fe=_[de],rt=_[ye];Fe!=null&&ze(Fe,X[de],Z,Ne,Z.sorted),rt!=null&&ze(rt,X[ye],ae,Ue,ae.sorted),L.min=ae.min,L.max=ae.max}});for(let L in _){let k=_[L],Z=X[L];if(k.from==null&&(Z==null||Z.min==null)){let ae=k.range(i,k.min==Ht?null:k.min,k.max==-Ht?null:k.max,L);k.min=ae[0],k.max=ae[1]}}}for(let L in _){let k=_[L];if(k.from!=null){let Z=_[k.from];if(Z.min==null)k.min=k.max=null;else{let ae=k.range(i,Z.min,Z.max,L);k.min=ae[0],k.max=ae[1]}}}let M={},I=!1;for(let L in _){let k=_[L],Z=S[L];if(Z.min!=k.min||Z.max!=k.max){Z.min=k.min,Z.max=k.max;let ae=Z.distr;Z._min=ae==3?ir(Z.min):ae==4?cp(Z.min,Z.asinh):ae==100?Z.fwd(Z.min):Z.min,Z._max=ae==3?ir(Z.max):ae==4?cp(Z.max,Z.asinh):ae==100?Z.fwd(Z.max):Z.max,M[L]=I=!0}}if(I){x.forEach((L,k)=>{s==2?k>0&&M.y&&(L._paths=null):M[L.scale]&&(L._paths=null)});for(let L in M)xe=!0,Bn("setScale",L);me&&he.left>=0&&(te=pe=!0)}for(let L in X)X[L]=null}function ke(_){let M=_p(hn-1,0,an-1),I=_p(fn+1,0,an-1);for(;_[M]==null&&M>0;)M--;for(;_[I]==null&&I<an-1;)I++;return[M,I]}function mt(){if(an>0){let _=x.some(M=>M._focus)&&Pe!=Be.alpha;_&&(h.globalAlpha=Pe=Be.alpha),x.forEach((M,I)=>{if(I>0&&M.show&&(sn(I,!1),sn(I,!0),M._paths==null)){let L=Pe;Pe!=M.alpha&&(h.globalAlpha=Pe=M.alpha);let k=s==2?[0,e[I][0].length-1]:ke(e[I]);M._paths=M.paths(i,I,k[0],k[1]),Pe!=L&&(h.globalAlpha=Pe=L)}}),x.forEach((M,I)=>{if(I>0&&M.show){let L=Pe;Pe!=M.alpha&&(h.globalAlpha=Pe=M.alpha),M._paths!=null&&Ot(I,!1);{let k=M._paths!=null?M._paths.gaps:null,Z=M.points.show(i,I,hn,fn,k),ae=M.points.filter(i,I,Z,k);(Z||ae)&&(M.points._paths=M.points.paths(i,I,hn,fn,ae),Ot(I,!0))}Pe!=L&&(h.globalAlpha=Pe=L),Bn("drawSeries",I)}}),_&&(h.globalAlpha=Pe=1)}}function sn(_,M){let I=M?x[_].points:x[_];I._stroke=I.stroke(i,_),I._fill=I.fill(i,_)}function Ot(_,M){let I=M?x[_].points:x[_],{stroke:L,fill:k,clip:Z,flags:ae,_stroke:de=I._stroke,_fill:ye=I._fill,_width:Ne=I.width}=I._paths;Ne=Wt(Ne*Dt,3);let Ue=null,Fe=Ne%2/2;M&&ye==null&&(ye=Ne>0?"#fff":de);let rt=I.pxAlign==1&&Fe>0;if(rt&&h.translate(Fe,Fe),!M){let It=P-Ne/2,Rt=b-Ne/2,xt=q+Ne,Ke=ue+Ne;Ue=new Path2D,Ue.rect(It,Rt,xt,Ke)}M?Oe(de,Ne,I.dash,I.cap,ye,L,k,ae,Z):Ft(_,de,Ne,I.dash,I.cap,ye,L,k,ae,Ue,Z),rt&&h.translate(-Fe,-Fe)}function Ft(_,M,I,L,k,Z,ae,de,ye,Ne,Ue){let Fe=!1;ye!=0&&C.forEach((rt,It)=>{if(rt.series[0]==_){let Rt=x[rt.series[1]],xt=e[rt.series[1]],Ke=(Rt._paths||Gl).band;Nr(Ke)&&(Ke=rt.dir==1?Ke[0]:Ke[1]);let Xe,Zt=null;Rt.show&&Ke&&AA(xt,hn,fn)?(Zt=rt.fill(i,It)||Z,Xe=Rt._paths.clip):Ke=null,Oe(M,I,L,k,Zt,ae,de,ye,Ne,Ue,Xe,Ke),Fe=!0}}),Fe||Oe(M,I,L,k,Z,ae,de,ye,Ne,Ue)}let En=Ta|yp;function Oe(_,M,I,L,k,Z,ae,de,ye,Ne,Ue,Fe){Ae(_,M,I,L,k),(ye||Ne||Fe)&&(h.save(),ye&&h.clip(ye),Ne&&h.clip(Ne)),Fe?(de&En)==En?(h.clip(Fe),Ue&&h.clip(Ue),St(k,ae),mn(_,Z,M)):de&yp?(St(k,ae),h.clip(Fe),mn(_,Z,M)):de&Ta&&(h.save(),h.clip(Fe),Ue&&h.clip(Ue),St(k,ae),h.restore(),mn(_,Z,M)):(St(k,ae),mn(_,Z,M)),(ye||Ne||Fe)&&h.restore()}function mn(_,M,I){I>0&&(M instanceof Map?M.forEach((L,k)=>{h.strokeStyle=yo=k,h.stroke(L)}):M!=null&&_&&h.stroke(M))}function St(_,M){M instanceof Map?M.forEach((I,L)=>{h.fillStyle=or=L,h.fill(I)}):M!=null&&_&&h.fill(M)}function Ns(_,M,I,L){let k=R[_],Z;if(L<=0)Z=[0,0];else{let ae=k._space=k.space(i,_,M,I,L),de=k._incrs=k.incrs(i,_,M,I,L,ae);Z=YE(M,I,de,L,ae)}return k._found=Z}function gn(_,M,I,L,k,Z,ae,de,ye,Ne){let Ue=ae%2/2;y==1&&h.translate(Ue,Ue),Ae(de,ae,ye,Ne,de),h.beginPath();let Fe,rt,It,Rt,xt=k+(L==0||L==3?-Z:Z);I==0?(rt=k,Rt=xt):(Fe=k,It=xt);for(let Ke=0;Ke<_.length;Ke++)M[Ke]!=null&&(I==0?Fe=It=_[Ke]:rt=Rt=_[Ke],h.moveTo(Fe,rt),h.lineTo(It,Rt));h.stroke(),y==1&&h.translate(-Ue,-Ue)}function So(_){let M=!0;return R.forEach((I,L)=>{if(!I.show)return;let k=S[I.scale];if(k.min==null){I._show&&(M=!1,I._show=!1,ht(!1));return}else I._show||(M=!1,I._show=!0,ht(!1));let Z=I.side,ae=Z%2,{min:de,max:ye}=k,[Ne,Ue]=Ns(L,de,ye,ae==0?F:Re);if(Ue==0)return;let Fe=k.distr==2,rt=I._splits=I.splits(i,L,de,ye,Ne,Ue,Fe),It=k.distr==2?rt.map(Xe=>Si[Xe]):rt,Rt=k.distr==2?Si[rt[1]]-Si[rt[0]]:Ne,xt=I._values=I.values(i,I.filter(i,It,L,Ue,Rt),L,Ue,Rt);I._rotate=Z==2?I.rotate(i,xt,L,Ue):0;let Ke=I._size;I._size=Xi(I.size(i,xt,L,_)),Ke!=null&&I._size!=Ke&&(M=!1)}),M}function ms(_){let M=!0;return Ia.forEach((I,L)=>{let k=I(i,L,ds,_);k!=qi[L]&&(M=!1),qi[L]=k}),M}function Us(){for(let _=0;_<R.length;_++){let M=R[_];if(!M.show||!M._show)continue;let I=M.side,L=I%2,k,Z,ae=M.stroke(i,_),de=I==0||I==3?-1:1,[ye,Ne]=M._found;if(M.label!=null){let ai=M.labelGap*de,Ti=Dn((M._lpos+ai)*Dt);Ie(M.labelFont[0],ae,"center",I==2?"top":K0),h.save(),L==1?(k=Z=0,h.translate(Ti,Dn(b+ue/2)),h.rotate((I==3?-Ih:Ih)/2)):(k=Dn(P+q/2),Z=Ti);let Br=kv(M.label)?M.label(i,_,ye,Ne):M.label;h.fillText(Br,k,Z),h.restore()}if(Ne==0)continue;let Ue=S[M.scale],Fe=L==0?q:ue,rt=L==0?P:b,It=M._splits,Rt=Ue.distr==2?It.map(ai=>Si[ai]):It,xt=Ue.distr==2?Si[It[1]]-Si[It[0]]:ye,Ke=M.ticks,Xe=M.border,Zt=Ke.show?Ke.size:0,cn=Dn(Zt*Dt),kn=Dn((M.alignTo==2?M._size-Zt-M.gap:M.gap)*Dt),zt=M._rotate*-Ih/180,un=p(M._pos*Dt),Mi=(cn+kn)*de,oi=un+Mi;Z=L==0?oi:0,k=L==1?oi:0;let Ui=M.font[0],Yi=M.align==1?xa:M.align==2?op:zt>0?xa:zt<0?op:L==0?"center":I==3?op:xa,vs=zt||L==1?"middle":I==2?"top":K0;Ie(Ui,ae,Yi,vs);let wi=M.font[1]*M.lineGap,Oi=It.map(ai=>p(a(ai,Ue,Fe,rt))),$i=M._values;for(let ai=0;ai<$i.length;ai++){let Ti=$i[ai];if(Ti!=null){L==0?k=Oi[ai]:Z=Oi[ai],Ti=""+Ti;let Br=Ti.indexOf(`
`)==-1?[Ti]:Ti.split(/\n/gm);for(let li=0;li<Br.length;li++){let rm=Br[li];zt?(h.save(),h.translate(k,Z+li*wi),h.rotate(zt),h.fillText(rm,0,0),h.restore()):h.fillText(rm,k,Z+li*wi)}}}Ke.show&&gn(Oi,Ke.filter(i,Rt,_,Ne,xt),L,I,un,cn,Wt(Ke.width*Dt,3),Ke.stroke(i,_),Ke.dash,Ke.cap);let xs=M.grid;xs.show&&gn(Oi,xs.filter(i,Rt,_,Ne,xt),L,L==0?2:1,L==0?b:P,L==0?ue:q,Wt(xs.width*Dt,3),xs.stroke(i,_),xs.dash,xs.cap),Xe.show&&gn([un],[1],L==0?1:0,L==0?1:2,L==1?b:P,L==1?ue:q,Wt(Xe.width*Dt,3),Xe.stroke(i,_),Xe.dash,Xe.cap)}Bn("drawAxes")}function ht(_){x.forEach((M,I)=>{I>0&&(M._paths=null,_&&(s==1?(M.min=null,M.max=null):M.facets.forEach(L=>{L.min=null,L.max=null})))})}let ln=!1,ri=!1,Bt=[];function _n(){ri=!1;for(let _=0;_<Bt.length;_++)Bn(...Bt[_]);Bt.length=0}function $n(){ln||(zA(Vp),ln=!0)}function Xl(_,M=!1){ln=!0,ri=M,_(i),Vp(),M&&Bt.length>0&&queueMicrotask(_n)}i.batch=Xl;function Vp(){if(oe&&(pt(),oe=!1),xe&&(we(),xe=!1),_e){if(Qt(d,xa,$e),Qt(d,"top",lt),Qt(d,Bl,F),Qt(d,kl,Re),Qt(g,xa,$e),Qt(g,"top",lt),Qt(g,Bl,F),Qt(g,kl,Re),Qt(f,Bl,on),Qt(f,kl,pn),u.width=Dn(on*Dt),u.height=Dn(pn*Dt),R.forEach(({_el:_,_show:M,_size:I,_pos:L,side:k})=>{if(_!=null)if(M){let Z=k===3||k===0?I:0,ae=k%2==1;Qt(_,ae?"left":"top",L-Z),Qt(_,ae?"width":"height",I),Qt(_,ae?"top":"left",ae?lt:$e),Qt(_,ae?"height":"width",ae?Re:F),mp(_,mo)}else Li(_,mo)}),yo=or=bo=B=j=Y=$=Te=w=null,Pe=1,Oa(!0),$e!=Me||lt!=Gt||F!=Ve||Re!=qe){ht(!1);let _=F/Ve,M=Re/qe;if(me&&!te&&he.left>=0){he.left*=_,he.top*=M,Mo&&Is(Mo,Dn(he.left),0,F,Re),wo&&Is(wo,0,Dn(he.top),F,Re);for(let I=0;I<ct.length;I++){let L=ct[I];L!=null&&(qt[I]*=_,si[I]*=M,Is(L,Xi(qt[I]),Xi(si[I]),F,Re))}}if($t.show&&!ie&&$t.left>=0&&$t.width>0){$t.left*=_,$t.width*=_,$t.top*=M,$t.height*=M;for(let I in Zh)Qt(Eo,I,$t[I])}Me=$e,Gt=lt,Ve=F,qe=Re}Bn("setSize"),_e=!1}on>0&&pn>0&&(h.clearRect(0,0,u.width,u.height),Bn("drawClear"),T.forEach(_=>_()),Bn("draw")),$t.show&&ie&&(ql($t),ie=!1),me&&te&&(Fr(null,!0,!1),te=!1),fe.show&&fe.live&&pe&&(Yh(),pe=!1),l||(l=!0,i.status=1,Bn("ready")),rr=!1,ln=!1}i.redraw=(_,M)=>{xe=M||!1,_!==!1?lr(E,D.min,D.max):$n()};function Wh(_,M){let I=S[_];if(I.from==null){if(an==0){let L=I.range(i,M.min,M.max,_);M.min=L[0],M.max=L[1]}if(M.min>M.max){let L=M.min;M.min=M.max,M.max=L}if(an>1&&M.min!=null&&M.max!=null&&M.max-M.min<1e-16)return;_==E&&I.distr==2&&an>0&&(M.min=hs(M.min,e[0]),M.max=hs(M.max,e[0]),M.min==M.max&&M.max++),X[_]=M,oe=!0,$n()}}i.setScale=Wh;let Xh,qh,Mo,wo,Gp,Hp,To,Ao,Wp,Xp,Yt,tn,ar=!1,Wn=he.drag,On=Wn.x,Fn=Wn.y;me&&(he.x&&(Xh=Wi(uA,g)),he.y&&(qh=Wi(hA,g)),D.ori==0?(Mo=Xh,wo=qh):(Mo=qh,wo=Xh),Yt=he.left,tn=he.top);let $t=i.select=Tn({show:!0,over:!0,left:0,width:0,top:0,height:0},n.select),Eo=$t.show?Wi(cA,$t.over?g:d):null;function ql(_,M){if($t.show){for(let I in _)$t[I]=_[I],I in Zh&&Qt(Eo,I,_[I]);M!==!1&&Bn("setSelect")}}i.setSelect=ql;function wx(_){if(x[_].show)ee&&mp(at[_],mo);else if(ee&&Li(at[_],mo),me){let I=Ce?ct[0]:ct[_];I!=null&&Is(I,-10,-10,F,Re)}}function lr(_,M,I){Wh(_,{min:M,max:I})}function gs(_,M,I,L){M.focus!=null&&Rx(_),M.show!=null&&x.forEach((k,Z)=>{Z>0&&(_==Z||_==null)&&(k.show=M.show,wx(Z),s==2?(lr(k.facets[0].scale,null,null),lr(k.facets[1].scale,null,null)):lr(k.scale,null,null),$n())}),I!==!1&&Bn("setSeries",_,M),L&&Fa("setSeries",i,_,M)}i.setSeries=gs;function Tx(_,M){Tn(C[_],M)}function Ax(_,M){_.fill=wt(_.fill||null),_.dir=Pt(_.dir,-1),M=M??C.length,C.splice(M,0,_)}function Ex(_){_==null?C.length=0:C.splice(_,1)}i.addBand=Ax,i.setBand=Tx,i.delBand=Ex;function Cx(_,M){x[_].alpha=M,me&&ct[_]!=null&&(ct[_].style.opacity=M),ee&&at[_]&&(at[_].style.opacity=M)}let Os,cr,Or,Co={focus:!0};function Rx(_){if(_!=Or){let M=_==null,I=Be.alpha!=1;x.forEach((L,k)=>{if(s==1||k>0){let Z=M||k==0||k==_;L._focus=M?null:Z,I&&Cx(k,Z?1:Be.alpha)}}),Or=_,I&&$n()}}ee&&je&&At(ev,Ee,_=>{he._lock||(Je(_),Or!=null&&gs(null,Co,!0,vn.setSeries))});function _s(_,M,I){let L=S[M];I&&(_=_/Dt-(L.ori==1?lt:$e));let k=F;L.ori==1&&(k=Re,_=k-_),L.dir==-1&&(_=k-_);let Z=L._min,ae=L._max,de=_/k,ye=Z+(ae-Z)*de,Ne=L.distr;return Ne==3?Sa(10,ye):Ne==4?CA(ye,L.asinh):Ne==100?L.bwd(ye):ye}function Px(_,M){let I=_s(_,E,M);return hs(I,e[0],hn,fn)}i.valToIdx=_=>hs(_,e[0]),i.posToIdx=Px,i.posToVal=_s,i.valToPos=(_,M,I)=>S[M].ori==0?r(_,S[M],I?q:F,I?P:0):o(_,S[M],I?ue:Re,I?b:0),i.setCursor=(_,M,I)=>{Yt=_.left,tn=_.top,Fr(null,M,I)};function qp(_,M){Qt(Eo,xa,$t.left=_),Qt(Eo,Bl,$t.width=M)}function Yp(_,M){Qt(Eo,"top",$t.top=_),Qt(Eo,kl,$t.height=M)}let Na=D.ori==0?qp:Yp,Ua=D.ori==1?qp:Yp;function Ix(){if(ee&&fe.live)for(let _=s==2?1:0;_<x.length;_++){if(_==0&&ut)continue;let M=fe.values[_],I=0;for(let L in M)Ge[_][I++].firstChild.nodeValue=M[L]}}function Yh(_,M){if(_!=null&&(_.idxs?_.idxs.forEach((I,L)=>{se[L]=I}):LA(_.idx)||se.fill(_.idx),fe.idx=se[0]),ee&&fe.live){for(let I=0;I<x.length;I++)(I>0||s==1&&!ut)&&Lx(I,se[I]);Ix()}pe=!1,M!==!1&&Bn("setLegend")}i.setLegend=Yh;function Lx(_,M){let I=x[_],L=_==0&&W==2?Si:e[_],k;ut?k=I.values(i,_,M)??st:(k=I.value(i,M==null?null:L[M],_,M),k=k==null?st:{_:k}),fe.values[_]=k}function Fr(_,M,I){Wp=Yt,Xp=tn,[Yt,tn]=he.move(i,Yt,tn),he.left=Yt,he.top=tn,me&&(Mo&&Is(Mo,Dn(Yt),0,F,Re),wo&&Is(wo,0,Dn(tn),F,Re));let L,k=hn>fn;Os=Ht,cr=null;let Z=D.ori==0?F:Re,ae=D.ori==1?F:Re;if(Yt<0||an==0||k){L=he.idx=null;for(let de=0;de<x.length;de++){let ye=ct[de];ye!=null&&Is(ye,-10,-10,F,Re)}je&&gs(null,Co,!0,_==null&&vn.setSeries),fe.live&&(se.fill(L),pe=!0)}else{let de,ye,Ne;s==1&&(de=D.ori==0?Yt:tn,ye=_s(de,E),L=he.idx=hs(ye,e[0],hn,fn),Ne=G(e[0][L],D,Z,0));let Ue=-10,Fe=-10,rt=0,It=0,Rt=!0,xt="",Ke="";for(let Xe=s==2?1:0;Xe<x.length;Xe++){let Zt=x[Xe],cn=se[Xe],kn=cn==null?null:s==1?e[Xe][cn]:e[Xe][1][cn],zt=he.dataIdx(i,Xe,L,ye),un=zt==null?null:s==1?e[Xe][zt]:e[Xe][1][zt];if(pe=pe||un!=kn||zt!=cn,se[Xe]=zt,Xe>0&&Zt.show){let Mi=zt==null?-10:zt==L?Ne:G(s==1?e[0][zt]:e[Xe][0][zt],D,Z,0),oi=un==null?-10:U(un,s==1?S[Zt.scale]:S[Zt.facets[1].scale],ae,0);if(je&&un!=null){let Ui=D.ori==1?Yt:tn,Yi=Nn(Be.dist(i,Xe,zt,oi,Ui));if(Yi<Os){let vs=Be.bias;if(vs!=0){let wi=_s(Ui,Zt.scale),Oi=un>=0?1:-1,$i=wi>=0?1:-1;$i==Oi&&($i==1?vs==1?un>=wi:un<=wi:vs==1?un<=wi:un>=wi)&&(Os=Yi,cr=Xe)}else Os=Yi,cr=Xe}}if(pe||Ce){let Ui,Yi;D.ori==0?(Ui=Mi,Yi=oi):(Ui=oi,Yi=Mi);let vs,wi,Oi,$i,xs,ai,Ti=!0,Br=le.bbox;if(Br!=null){Ti=!1;let li=Br(i,Xe);Oi=li.left,$i=li.top,vs=li.width,wi=li.height}else Oi=Ui,$i=Yi,vs=wi=le.size(i,Xe);if(ai=le.fill(i,Xe),xs=le.stroke(i,Xe),Ce)Xe==cr&&Os<=Be.prox&&(Ue=Oi,Fe=$i,rt=vs,It=wi,Rt=Ti,xt=ai,Ke=xs);else{let li=ct[Xe];li!=null&&(qt[Xe]=Oi,si[Xe]=$i,av(li,vs,wi,Ti),rv(li,ai,xs),Is(li,Xi(Oi),Xi($i),F,Re))}}}}if(Ce){let Xe=Be.prox,Zt=Or==null?Os<=Xe:Os>Xe||cr!=Or;if(pe||Zt){let cn=ct[0];cn!=null&&(qt[0]=Ue,si[0]=Fe,av(cn,rt,It,Rt),rv(cn,xt,Ke),Is(cn,Xi(Ue),Xi(Fe),F,Re))}}}if($t.show&&ar)if(_!=null){let[de,ye]=vn.scales,[Ne,Ue]=vn.match,[Fe,rt]=_.cursor.sync.scales,It=_.cursor.drag;if(On=It._x,Fn=It._y,On||Fn){let{left:Rt,top:xt,width:Ke,height:Xe}=_.select,Zt=_.scales[Fe].ori,cn=_.posToVal,kn,zt,un,Mi,oi,Ui=de!=null&&Ne(de,Fe),Yi=ye!=null&&Ue(ye,rt);Ui&&On?(Zt==0?(kn=Rt,zt=Ke):(kn=xt,zt=Xe),un=S[de],Mi=G(cn(kn,Fe),un,Z,0),oi=G(cn(kn+zt,Fe),un,Z,0),Na(fs(Mi,oi),Nn(oi-Mi))):Na(0,Z),Yi&&Fn?(Zt==1?(kn=Rt,zt=Ke):(kn=xt,zt=Xe),un=S[ye],Mi=U(cn(kn,rt),un,ae,0),oi=U(cn(kn+zt,rt),un,ae,0),Ua(fs(Mi,oi),Nn(oi-Mi))):Ua(0,ae)}else Kh()}else{let de=Nn(Wp-Gp),ye=Nn(Xp-Hp);if(D.ori==1){let rt=de;de=ye,ye=rt}On=Wn.x&&de>=Wn.dist,Fn=Wn.y&&ye>=Wn.dist;let Ne=Wn.uni;Ne!=null?On&&Fn&&(On=de>=Ne,Fn=ye>=Ne,!On&&!Fn&&(ye>de?Fn=!0:On=!0)):Wn.x&&Wn.y&&(On||Fn)&&(On=Fn=!0);let Ue,Fe;On&&(D.ori==0?(Ue=To,Fe=Yt):(Ue=Ao,Fe=tn),Na(fs(Ue,Fe),Nn(Fe-Ue)),Fn||Ua(0,ae)),Fn&&(D.ori==1?(Ue=To,Fe=Yt):(Ue=Ao,Fe=tn),Ua(fs(Ue,Fe),Nn(Fe-Ue)),On||Na(0,Z)),!On&&!Fn&&(Na(0,0),Ua(0,0))}if(Wn._x=On,Wn._y=Fn,_==null){if(I){if(sm!=null){let[de,ye]=vn.scales;vn.values[0]=de!=null?_s(D.ori==0?Yt:tn,de):null,vn.values[1]=ye!=null?_s(D.ori==1?Yt:tn,ye):null}Fa(ap,i,Yt,tn,F,Re,L)}if(je){let de=I&&vn.setSeries,ye=Be.prox;Or==null?Os<=ye&&gs(cr,Co,!0,de):Os>ye?gs(null,Co,!0,de):cr!=Or&&gs(cr,Co,!0,de)}}pe&&(fe.idx=L,Yh()),M!==!1&&Bn("setCursor")}let ur=null;Object.defineProperty(i,"rect",{get(){return ur==null&&Oa(!1),ur}});function Oa(_=!1){_?ur=null:(ur=g.getBoundingClientRect(),Bn("syncRect",ur))}function $p(_,M,I,L,k,Z,ae){he._lock||ar&&_!=null&&_.movementX==0&&_.movementY==0||($h(_,M,I,L,k,Z,ae,!1,_!=null),_!=null?Fr(null,!0,!0):Fr(M,!0,!1))}function $h(_,M,I,L,k,Z,ae,de,ye){if(ur==null&&Oa(!1),Je(_),_!=null)I=_.clientX-ur.left,L=_.clientY-ur.top;else{if(I<0||L<0){Yt=-10,tn=-10;return}let[Ne,Ue]=vn.scales,Fe=M.cursor.sync,[rt,It]=Fe.values,[Rt,xt]=Fe.scales,[Ke,Xe]=vn.match,Zt=M.axes[0].side%2==1,cn=D.ori==0?F:Re,kn=D.ori==1?F:Re,zt=Zt?Z:k,un=Zt?k:Z,Mi=Zt?L:I,oi=Zt?I:L;if(Rt!=null?I=Ke(Ne,Rt)?a(rt,S[Ne],cn,0):-10:I=cn*(Mi/zt),xt!=null?L=Xe(Ue,xt)?a(It,S[Ue],kn,0):-10:L=kn*(oi/un),D.ori==1){let Ui=I;I=L,L=Ui}}ye&&(M==null||M.cursor.event.type==ap)&&((I<=1||I>=F-1)&&(I=fo(I,F)),(L<=1||L>=Re-1)&&(L=fo(L,Re))),de?(Gp=I,Hp=L,[To,Ao]=he.move(i,I,L)):(Yt=I,tn=L)}let Zh={width:0,height:0,left:0,top:0};function Kh(){ql(Zh,!1)}let Zp,Kp,Jp,jp;function Qp(_,M,I,L,k,Z,ae){ar=!0,On=Fn=Wn._x=Wn._y=!1,$h(_,M,I,L,k,Z,ae,!0,!1),_!=null&&(At(lp,dp,em,!1),Fa(j0,i,To,Ao,F,Re,null));let{left:de,top:ye,width:Ne,height:Ue}=$t;Zp=de,Kp=ye,Jp=Ne,jp=Ue}function em(_,M,I,L,k,Z,ae){ar=Wn._x=Wn._y=!1,$h(_,M,I,L,k,Z,ae,!1,!0);let{left:de,top:ye,width:Ne,height:Ue}=$t,Fe=Ne>0||Ue>0,rt=Zp!=de||Kp!=ye||Jp!=Ne||jp!=Ue;if(Fe&&rt&&ql($t),Wn.setScale&&Fe&&rt){let It=de,Rt=Ne,xt=ye,Ke=Ue;if(D.ori==1&&(It=ye,Rt=Ue,xt=de,Ke=Ne),On&&lr(E,_s(It,E),_s(It+Rt,E)),Fn)for(let Xe in S){let Zt=S[Xe];Xe!=E&&Zt.from==null&&Zt.min!=Ht&&lr(Xe,_s(xt+Ke,Xe),_s(xt,Xe))}Kh()}else he.lock&&(he._lock=!he._lock,Fr(M,!0,_!=null));_!=null&&(An(lp,dp),Fa(lp,i,Yt,tn,F,Re,null))}function Dx(_,M,I,L,k,Z,ae){if(he._lock)return;Je(_);let de=ar;if(ar){let ye=!0,Ne=!0,Ue=10,Fe,rt;D.ori==0?(Fe=On,rt=Fn):(Fe=Fn,rt=On),Fe&&rt&&(ye=Yt<=Ue||Yt>=F-Ue,Ne=tn<=Ue||tn>=Re-Ue),Fe&&ye&&(Yt=Yt<To?0:F),rt&&Ne&&(tn=tn<Ao?0:Re),Fr(null,!0,!0),ar=!1}Yt=-10,tn=-10,se.fill(null),Fr(null,!0,!0),de&&(ar=de)}function tm(_,M,I,L,k,Z,ae){he._lock||(Je(_),Da(),Kh(),_!=null&&Fa(tv,i,Yt,tn,F,Re,null))}function nm(){R.forEach($E),O(i.width,i.height,!0)}go(Lh,ba,nm);let Ro={};Ro.mousedown=Qp,Ro.mousemove=$p,Ro.mouseup=em,Ro.dblclick=tm,Ro.setSeries=(_,M,I,L)=>{let k=vn.match[2];I=k(i,M,I),I!=-1&&gs(I,L,!0,!1)},me&&(At(j0,g,Qp),At(ap,g,$p),At(Q0,g,_=>{Je(_),Oa(!1)}),At(ev,g,Dx),At(tv,g,tm),bp.add(i),i.syncRect=Oa);let Yl=i.hooks=n.hooks||{};function Bn(_,M,I){ri?Bt.push([_,M,I]):_ in Yl&&Yl[_].forEach(L=>{L.call(null,i,M,I)})}(n.plugins||[]).forEach(_=>{for(let M in _.hooks)Yl[M]=(Yl[M]||[]).concat(_.hooks[M])});let im=(_,M,I)=>I,vn=Tn({key:null,setSeries:!1,filters:{pub:fv,sub:fv},scales:[E,x[1]?x[1].scale:null],match:[dv,dv,im],values:[null,null]},he.sync);vn.match.length==2&&vn.match.push(im),he.sync=vn;let sm=vn.key,Jh=cx(sm);function Fa(_,M,I,L,k,Z,ae){vn.filters.pub(_,M,I,L,k,Z,ae)&&Jh.pub(_,M,I,L,k,Z,ae)}Jh.sub(i);function Nx(_,M,I,L,k,Z,ae){vn.filters.sub(_,M,I,L,k,Z,ae)&&Ro[_](null,M,I,L,k,Z,ae)}i.pub=Nx;function Ux(){Jh.unsub(i),bp.delete(i),Un.clear(),gp(Lh,ba,nm),c.remove(),Ee?.remove(),Bn("destroy")}i.destroy=Ux;function jh(){Bn("init",n,e),La(e||n.data,!1),X[E]?Wh(E,X[E]):Da(),ie=$t.show&&($t.width>0||$t.height>0),te=pe=!0,O(n.width,n.height)}return x.forEach(xo),R.forEach(Ls),t?t instanceof HTMLElement?(t.appendChild(c),jh()):t(i,jh):jh(),i}Yn.assign=Tn;Yn.fmtNum=Cp;Yn.rangeNum=Dh;Yn.rangeLog=Oh;Yn.rangeAsinh=Ap;Yn.orient=vo;Yn.pxRatio=Dt;Yn.join=kA;Yn.fmtDate=Pp,Yn.tzDate=KA;Yn.sync=cx;{Yn.addGap=LE,Yn.clipGaps=kh;let n=Yn.paths={points:mx};n.linear=_x,n.stepped=UE,n.bars=OE,n.spline=BE}var kp=2,ZE=300,Ra=Ze([]),zp=Ze(null),Fp=/route="\/(describe|match|localize)"/;function KE(n){let e={requests:0,seconds:0,buckets:new Map,refused:0,queue:0,maps:0,segments:0};for(let t of n.split(`
`)){if(!t||t.startsWith("#"))continue;let i=t.lastIndexOf(" "),[s,r]=[t.slice(0,i),Number(t.slice(i+1))];if(s.startsWith("placecell_request_seconds_count{")&&Fp.test(s))e.requests+=r;else if(s.startsWith("placecell_request_seconds_sum{")&&Fp.test(s))e.seconds+=r;else if(s.startsWith("placecell_request_seconds_bucket{")&&Fp.test(s)){let o=Number(/le="([^"]+)"/.exec(s)[1].replace("+Inf","Infinity"));e.buckets.set(o,(e.buckets.get(o)??0)+r)}else s.startsWith("placecell_rejected_total")?e.refused+=r:s==="placecell_queue_requests"?e.queue=r:s==="placecell_maps"?e.maps=r:s==="placecell_map_segments"&&(e.segments=r)}return e}function JE(n,e){let t=n.requests-e.requests;for(let i of[...n.buckets.keys()].sort((s,r)=>s-r))if(n.buckets.get(i)-(e.buckets.get(i)??0)>=.99*t)return 1e3*i;return 1/0}async function bx(){let n=await gt.metrics().catch(()=>null);if(n===null)return;let e=KE(n),t=zp.value;if(zp.value=e,!t||e.requests<t.requests)return;let i=e.requests-t.requests;Ra.value=[...Ra.value.slice(1-ZE),{time:Date.now()/1e3,requests:i/kp,seconds:i?1e3*(e.seconds-t.seconds)/i:NaN,slow:i?JE(e,t):NaN,queue:e.queue,refused:(e.refused-t.refused)/kp}]}function Sx(){Kt(()=>{bx();let e=setInterval(()=>{bx()},1e3*kp);return()=>clearInterval(e)},[]);let n=zp.value;return A(Ct,{children:[A("p",{children:["Placecell ",Xd.value,". ",n&&`${it(n.maps)} maps with ${it(n.segments)} segments. ${it(n.requests)} recognition requests and ${it(n.refused)} refusals since the start.`]}),ti.value&&A("p",{children:ti.value.open?"The service has no keys: everyone who reaches it may look at and change all maps.":vh(ti.value)}),!Ra.value.some(e=>e.requests>0)&&A("p",{class:"facts",role:"status",children:"No recognition request has come since this panel was opened."}),A(Bp,{title:"Latency, ms",lines:[["mean","seconds","#56b4e9"],["slowest 1%, at most","slow","#e69f00"]]}),A(Bp,{title:"Requests waiting or in work",lines:[["queue","queue","#009e73"]]}),A(Bp,{title:"Requests a second",lines:[["requests","requests","#56b4e9"],["refused","refused","#d55e00"]]}),A("p",{children:A("a",{href:"docs",target:"_blank",rel:"noopener",children:"API documentation"})})]})}function Bp(n){let e=Zn(null),t=Zn(null),i=()=>[Ra.value.map(r=>r.time),...n.lines.map(([,r])=>Ra.value.map(o=>Number.isFinite(o[r])?o[r]:null))];Kt(()=>{let r={stroke:"#b6c2cc",grid:{stroke:"#2a3947"},ticks:{stroke:"#2a3947"}},o=new Yn({width:e.current.clientWidth,height:120,cursor:{show:!1},legend:{show:!0,live:!1},scales:{y:{range:(c,u,h)=>[0,Math.max(h,1)]}},axes:[r,{...r,size:44}],series:[{},...n.lines.map(([c,,u],h)=>({label:c,stroke:u,width:2,...h?{dash:[6,4]}:{},spanGaps:!0}))]},i(),e.current);t.current=o;let a=e.current,l=new ResizeObserver(()=>o.setSize({width:a.clientWidth,height:120}));return l.observe(a),()=>{l.disconnect(),o.destroy()}},[]);let s=Ra.value;return Kt(()=>t.current?.setData(i()),[s]),A("figure",{children:[A("figcaption",{children:n.title}),A("div",{ref:e})]})}var Mx={maps:["Maps",V0],robots:["Robots",q0],locate:["Locate a scan",m0],service:["Service",Sx]};function jE(){Kt(()=>{let e=i=>i.preventDefault(),t=i=>{i.preventDefault();let s=i.dataTransfer?.files[0];s&&sp(s)};return addEventListener("dragover",e),addEventListener("drop",t),()=>{removeEventListener("dragover",e),removeEventListener("drop",t)}},[]);let[,n]=Mx[Ir.value];return A(Ct,{children:[A("header",{class:"bar",children:[A("h1",{children:"Placecell"}),A("span",{class:Hi.value.on?"state on":"state",role:"status",children:Hi.value.on?"connected":"not connected"}),ti.value&&!ti.value.open&&A("span",{class:"who",title:vh(ti.value),children:[ti.value.name," (",o0(ti.value),") ",A(ot,{kind:"plain",onClick:n0,children:"Sign out"})]})]}),A("nav",{"aria-label":"Panels",children:Object.entries(Mx).map(([e,[t]])=>A(ot,{pressed:Ir.value===e,onClick:()=>Ir.value=e,children:t},e))}),A("main",{class:"panel",children:A(n,{})}),A(P0,{}),er.value&&A($0,{}),A(Y0,{}),A("div",{class:"messages","aria-live":"assertive",children:Cs.value.map(e=>A("div",{class:e.kind,role:e.kind==="error"?"alert":"status",children:[A("div",{children:[A("b",{children:e.text}),e.detail&&A("span",{children:e.detail})]}),A(ot,{kind:"plain",onClick:()=>qd(e.id),children:"Close"})]},e.id))}),ho.value&&A(W0,{}),Qs.value!==null&&A(a0,{})]})}document.body.replaceChildren();vm(A(jE,{}),document.body);
